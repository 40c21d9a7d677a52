// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/pose.h"
#include "sensor/sensor.h"

namespace ispace {

/// True for a laser whose scans all lie in the slice at its height: level, and turning about the
/// vertical if it sweeps.
bool scansSlice(const Laser& laser, const Pose3& pose);
bool scansSlice(const Sensor& sensor);

/// Bearings between the first and the last beam of a laser, ends included.
struct BearingWindow {
    Vec2 middle;    ///< of unit length
    double cosine;  ///< of half the window, -1 if it is all around
    explicit BearingWindow(const Laser& laser, Angle more = {});
    /// For a place in the scan plane, in the sensor's frame; its own place is.
    [[nodiscard]] bool holds(Vec3 local) const;
};

/// Where a scan plane that is not level passes above or below the floor.
class ScanPlane {
  public:
    explicit ScanPlane(const Pose3& pose)
        : frame_(pose), up_(frame_.forward.x * frame_.left.y - frame_.forward.y * frame_.left.x) {}

    [[nodiscard]] const Frame3& frame() const { return frame_; }
    /// Vertical part of the normal; 0 if the plane stands upright.
    [[nodiscard]] double up() const { return up_; }
    /// Height of the plane over a place. \pre up() is not 0
    [[nodiscard]] double heightAt(Point2 p) const {
        const Vec3 &f = frame_.forward, &l = frame_.left;
        const double nx = f.y * l.z - f.z * l.y, ny = f.z * l.x - f.x * l.z;
        return frame_.origin.z -
               (nx * (p.x - frame_.origin.x) + ny * (p.y - frame_.origin.y)) / up_;
    }

  private:
    Frame3 frame_;
    double up_;
};

/// The scans of a laser that changes one angle of its pose, and all between them: which places they
/// pass, if nothing stands in the way.
class SweptScan {
  public:
    /// \pre placed.as<Laser>().sweep is not None
    explicit SweptScan(const Sensor& placed);

    /// True if some scan of the sweep has the place between its first and last beam.
    [[nodiscard]] bool passes(Point3 place) const;

  private:
    struct Turns {
        CosSin heading, tilt, roll;
        [[nodiscard]] Vec3 toSensor(Vec3 way) const;
    };
    /// The place lies in the scan plane where x cos s + y sin s + z = 0 for the swept angle s.
    [[nodiscard]] Vec3 equationOf(Vec3 way) const;
    [[nodiscard]] bool isSeenAt(CosSin swept, Vec3 way) const;
    [[nodiscard]] CosSin& sweptOf(Turns& turns) const;

    SweepAxis axis_;
    Point3 origin_;
    Turns turns_;           // at the beginning
    CosSin middle_;         // of the swept angle
    double cosine_;         // of half the sweep, -1 if it is a full turn
    BearingWindow window_;  // of one scan
    BearingWindow wide_;    // of all, where the scan plane turns in itself
};

}  // namespace ispace
