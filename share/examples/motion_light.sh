#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# An automation of a smart home: a lamp is on while a motion sensor detects people. It knows the broker alone, as it
# would with a real sensor and a real lamp:
#
#     mosquitto -p 1883 &
#     simrun flat.env flat.3dm --mqtt 127.0.0.1:1883 &
#     motion_light.sh s1 l1 -p 1883
#
# motion_light.sh SENSOR LAMP [OPTIONS of mosquitto_sub and mosquitto_pub]
set -eu
sensor=$1
lamp=$2
shift 2

mosquitto_sub "$@" -q 1 -t "ispace/$sensor/motion" | while read -r motion; do
    mosquitto_pub "$@" -q 1 -t "ispace/$lamp/on/set" -m "$motion"
done
