// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_csv.h"

#include <cmath>

#include "base/number.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

/// To the nanosecond.
void appendTime(std::string& out, double seconds) { appendDouble(out, nineDecimals(seconds)); }

void appendPoint(TextTail& tail, const PointCloud& cloud, std::size_t index) {
    const float* point = &cloud.xyz[3 * index];
    for (int part = 0; part < 3; ++part) {
        tail.put(',');
        if (!std::isnan(point[part])) tail.put(point[part]);
    }
    tail.put('\n');
}

void appendFigure(std::string& out, double value) {
    out += ',';
    appendDouble(out, value);
}

void appendPlace(std::string& out, const Burst& burst) {
    if (burst.fix) {
        const Fix& fix = *burst.fix;
        for (const double part : {fix.position.x, fix.position.y, fix.position.z, fix.residual,
                                  fix.pdop, fix.hdop, fix.vdop})
            appendFigure(out, part);
    } else if (burst.simple) {
        appendFigure(out, burst.simple->x);
        appendFigure(out, burst.simple->y);
        out += ",,,,,";
    } else {
        out += ",,,,,,,";
    }
}

}  // namespace

void appendCsvField(std::string& out, std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        out += text;
        return;
    }
    out += '"';
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
}

std::string laserCsvHeader() { return "sensor,frame,scan,t,beam,bearing_deg,range,x,y,z\n"; }

void appendLaserRows(std::string& out, const Sensor& sensor, std::span<const Scan> scans,
                     Coordinates in) {
    const Laser& laser = sensor.as<Laser>();
    const PointCloud cloud = cloudOf(laser, scans, in);
    std::size_t point = 0;
    for (const Scan& scan : scans) {
        std::string prefix;
        appendCsvField(prefix, sensor.id);
        prefix.append(",").append(std::to_string(scan.frame)).append(",");
        prefix.append(std::to_string(scan.number)).append(",");
        TextTail tail(out, scan.ranges.size() * (prefix.size() + 8 * kNumberRoom));
        for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
            tail.put(prefix);
            tail.putNineDecimals(scan.time + laser.timeOf(static_cast<int>(k)));
            tail.put(',');
            tail.put(k);
            tail.put(',');
            tail.put(static_cast<float>(laser.bearing(static_cast<int>(k)).degrees()));
            tail.put(',');
            if (std::isfinite(scan.ranges[k])) tail.put(scan.ranges[k]);
            appendPoint(tail, cloud, point++);
        }
    }
}

std::string rangerCsvHeader() { return "sensor,frame,t,column,row,depth,x,y,z\n"; }

void appendRangerRows(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                      Coordinates in) {
    const PointCloud cloud = cloudOf(sensor.as<Ranger>(), frame, in);
    std::string prefix;
    appendCsvField(prefix, sensor.id);
    prefix.append(",").append(std::to_string(frame.frame)).append(",");
    appendTime(prefix, frame.time);
    TextTail tail(out, cloud.size() * (prefix.size() + 6 * kNumberRoom));
    std::size_t index = 0;
    for (std::size_t row = 0; row < cloud.height; ++row) {
        for (std::size_t column = 0; column < cloud.width; ++column, ++index) {
            tail.put(prefix);
            tail.put(',');
            tail.put(column);
            tail.put(',');
            tail.put(row);
            tail.put(',');
            if (std::isfinite(frame.depths[index])) tail.put(frame.depths[index]);
            appendPoint(tail, cloud, index);
        }
    }
}

std::string ultrasoundCsvHeader() {
    return "sensor,frame,t,x,y,z,residual,pdop,hdop,vdop,heard,times\n";
}

void appendBurstRow(std::string& out, const Sensor& tag, const Burst& burst,
                    std::span<const Sensor> receivers) {
    appendCsvField(out, tag.id);
    out.append(",").append(std::to_string(burst.frame)).append(",");
    appendTime(out, burst.time);
    appendPlace(out, burst);
    out.append(",").append(std::to_string(burst.heard.size())).append(",");
    std::string times;
    for (const TimeOfFlight& flight : burst.heard) {
        if (!times.empty()) times += ' ';
        times.append(receivers[flight.receiver].id).append("=");
        appendDouble(times, flight.time);
    }
    appendCsvField(out, times);
    out += '\n';
}

}  // namespace ispace
