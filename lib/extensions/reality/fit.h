// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the noise of sensors and of odometry to a log, as records that `--noise` obeys.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "extensions/reality/beam_model.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace::reality {

/// Losses that grow with the angle of incidence: the share `dropout` everywhere, and from
/// `graze_from` to `graze_to` more, to all.
struct DropoutFit {
    double dropout = 0, error = 0;
    std::optional<std::pair<Angle, Angle>> graze = {};  ///< if the criterion justifies it
};
/// Fits it by maximum likelihood over whole degrees; `graze` by the Bayesian information criterion.
DropoutFit fitDropout(std::span<const BeamSample> samples);

/// The noise of one sensor.
struct SensorFit {
    std::string sensor;
    const Sensor* known = nullptr;  ///< of LAYOUT or --model
    BeamFit fit;                    ///< of all scans
    DropoutFit dropout;
    double resolution = 0;           ///< of which all ranges are multiples; 0: unknown
    double held_out = 0;             ///< mean log-likelihood of odd scans, fitted to even ones
    double held_out_known = 0;       ///< the same of the noise that the sensor had before
    std::size_t held_out_beams = 0;  ///< 0: a single scan
    bool measures_depth = false;
};

/// Fits each sensor of a simulated run.
std::vector<SensorFit> fitSensors(const LoggedRun& run);

/// Errors of odometry against corrected poses: variances of turn and way, see strayed() in
/// lib/engine/sim/odometry.h.
struct OdometryFit {
    std::size_t motions = 0;
    std::array<double, 4> alphas{}, errors{};       ///< variance a radian or a metre
    std::array<double, 4> thrun{}, thrun_errors{};  ///< variances alpha d^2 of each motion
    /// CARMEN's: standard deviations alpha |d| of each motion, those of turn and way added.
    std::array<double, 4> carmen{}, carmen_errors{};
    double turn_error = 0, way_error = 0;  ///< of the corrected poses: standard deviations
    double scale_turn = 0, scale_way = 0;  ///< means of errors a radian and a metre
};
/// Returns nullopt if the log has fewer than 20 motions with both poses.
std::optional<OdometryFit> fitOdometry(const Log& log);

/// A receiver of ultrasound.
struct UltrasoundFit {
    std::string receiver;
    const Sensor* known = nullptr;
    BeamFit fit;
};
/// Fits the distances that receivers measured to tags. \pre tags and receivers have their ids in
/// the scene
std::vector<UltrasoundFit> fitUltrasound(const Log& log, const Scene& scene, RayScenes& worlds);

/// Writes the fits as a layout: records without a pose for sensors that move, as comments the
/// standard errors and what records cannot hold.
std::string fittedLayout(const std::vector<SensorFit>& sensors,
                         const std::vector<UltrasoundFit>& ultrasound,
                         const std::optional<OdometryFit>& odometry, const LoggedRun& run,
                         const Scene& scene, const std::string& history_line);

}  // namespace ispace::reality
