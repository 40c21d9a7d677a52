// SPDX-License-Identifier: GPL-3.0-or-later
/// ARIA's classes for robots of simrun: a program that drives a Pioneer changes its include,
///
///     #include "Sim_Aria.h"     // instead of "Aria.h" or "Aria/Aria.h"
///
/// or, unchanged, is compiled with the folder aria/ in its include path, where both names lead
/// here. C++11, headers and -pthread alone. Then
///
///     simrun room.env robots.3dm --listen 127.0.0.1:7001 &
///     ISPACE_SIMRUN=127.0.0.1:7001 ISPACE_ROBOT=r1 ./program
///
/// Units and rounding are ARIA's: mm, degrees, speeds in whole mm/s and degrees/s, cycles of 100
/// ms. Time is the room's (sim_aria/clock.h): with `--clock real:20` all goes twenty times as fast,
/// and with `--clock step` the world advances while the program sleeps, the same way each time.
///
/// Supports direct motion, tasks, callbacks, actions and their groups, sonars, bumpers, lasers,
/// keys, configurations, functors and threads; ispace-wire(7) lists AriaCoda's examples by name.
/// Devices that a robot of simrun does not have (sim_aria/hardware.h) are missing at run time.
/// ArNetworking is not supported.
///
/// Names and meanings follow ARIA and AriaCoda; the code is ours. Errors are told as there: a
/// function returns false, or writes a line to the log and goes on. As there, hold ArRobot's lock
/// around commands and getters in other threads than its own.
#ifndef SIM_ARIA_H
#define SIM_ARIA_H

#include <sim_aria/action_groups.h>
#include <sim_aria/action_triangle.h>
#include <sim_aria/arguments.h>
#include <sim_aria/bumpers.h>
#include <sim_aria/commands.h>
#include <sim_aria/config.h>
#include <sim_aria/connection.h>
#include <sim_aria/connector.h>
#include <sim_aria/data_logger.h>
#include <sim_aria/file_parser.h>
#include <sim_aria/functor_kinds.h>
#include <sim_aria/gps_coords.h>
#include <sim_aria/hardware.h>
#include <sim_aria/interpolation.h>
#include <sim_aria/keys.h>
#include <sim_aria/laser_connector.h>
#include <sim_aria/laser_logger.h>
#include <sim_aria/line_finder.h>
#include <sim_aria/math.h>
#include <sim_aria/process.h>
#include <sim_aria/range_device.h>
#include <sim_aria/robot.h>
#include <sim_aria/sim_util.h>
#include <sim_aria/sounds.h>
#include <sim_aria/statistics.h>
#include <sim_aria/tcp_socket.h>
#include <sim_aria/thread.h>
#include <sim_aria/util.h>

#endif  // SIM_ARIA_H
