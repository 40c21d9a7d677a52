// SPDX-License-Identifier: GPL-3.0-or-later
/// Drives the robots and people of simrun and reads its sensors. C++11, header-only; requires only
/// the standard library and sockets.
///
///     #include <ispace_client.h>
///     using namespace ispace::client;
///
///     Robot robot("127.0.0.1:7001", "r1");
///     robot.wait(robot.forward(1.5));
///     if (robot.status().stall) robot.wait(robot.left(90));
///     LaserSensor laser("127.0.0.1:7001", "l1");
///     for (float range : laser.scan().ranges) …
///
/// Robot and Person drive; LaserSensor, Camera and similar classes read; World holds the clock,
/// changes and events; Node is a computer of a sensor network. Units are those of the protocol:
/// metres, degrees, simulated seconds; frames are right-handed and headings counter-clockwise.
/// Functions block until the server has answered, for at most Options::timeout seconds of wall
/// time; errors are exceptions of <ispace_client/error.h> with the server's text. In CMake:
/// find_package(ispace_client), ispace::client.
///
/// An object is one TCP connection and one role; use it in one thread at a time, and different
/// objects in different threads. Its destructor closes the connection: a robot then brakes, and
/// other clients may drive it. Each call is a round trip; streams save it, and send the newest
/// reading to a program that is slow. The protocol is ispace-protocol(7),
/// version 1; an object refuses servers of another version when it connects.
#ifndef ISPACE_CLIENT_H
#define ISPACE_CLIENT_H

#include <ispace_client/bumpers.h>
#include <ispace_client/error.h>
#include <ispace_client/floor.h>
#include <ispace_client/heads.h>
#include <ispace_client/locks.h>
#include <ispace_client/memory.h>
#include <ispace_client/meter.h>
#include <ispace_client/mote.h>
#include <ispace_client/node.h>
#include <ispace_client/pir.h>
#include <ispace_client/radar.h>
#include <ispace_client/radios.h>
#include <ispace_client/robot.h>
#include <ispace_client/sensor.h>
#include <ispace_client/smart_room.h>
#include <ispace_client/thermometer.h>
#include <ispace_client/uwb.h>
#include <ispace_client/world.h>

#endif  // ISPACE_CLIENT_H
