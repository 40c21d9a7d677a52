// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "sense/depth.h"
#include "sense/ultrasound.h"

namespace ispace {

// RFC 4180 with LF; metres, seconds, degrees; an empty field is no return. Numbers are in shortest
// form, bearings, ranges and places as float32; times are rounded to the nanosecond.

/// sensor,frame,scan,t,beam,bearing_deg,range,x,y,z: a row a beam, polar and orthogonal (thesis
/// fig. 3.24).
std::string laserCsvHeader();
/// Of all scans of a reading; in the sensor's frame that of the first.
void appendLaserRows(std::string& out, const Sensor& sensor, std::span<const Scan> scans,
                     Coordinates in);

/// sensor,frame,t,column,row,depth,x,y,z: a row a pixel.
std::string rangerCsvHeader();
void appendRangerRows(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                      Coordinates in);

/// sensor,frame,t,x,y,z,residual,pdop,hdop,vdop,heard,times: a row a burst; `times` are
/// RECEIVER=SECONDS separated by blanks. x,y,z is the place computed; of the simple model z is
/// empty.
std::string ultrasoundCsvHeader();
void appendBurstRow(std::string& out, const Sensor& tag, const Burst& burst,
                    std::span<const Sensor> receivers);

/// A field, in quotes if it needs them.
void appendCsvField(std::string& out, std::string_view text);

}  // namespace ispace
