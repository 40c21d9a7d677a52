// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs of arrange over all poses, not over candidates: the fewest lasers that see a floor, and
// bounds of the coverage of up to four sensors.
//
// What is proven: the area by exact geometry in doubles, with sight blocked by the edges of the
// free floor at the sensors' height. Bounds hold for every pose, headings included, and err to the
// safe side. A proof can be stored as a certificate and checked by other code (arrange --verify).
// Errors are UsageError for scenes that the proofs do not cover.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/prover.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "extensions/proofs/check_guards.h"
#include "extensions/proofs/poses/certificate.h"
#include "extensions/proofs/poses/outer_bound.h"
#include "scene/scene.h"

namespace ispace {
class CoverageModel;
}

namespace ispace::proofs {

/// The word of --proof.
constexpr std::string_view kOverPoses = "poses";

/// A proof of the least number of sensors over all poses.
struct FewestProof : public Proof {
    std::size_t cover = 0;  ///< number of sensors that see the floor but for `missed`; 0: unknown
    std::size_t bound = 0;  ///< fewer sensors, in any poses, do not see all witnesses
    double missed = 0;      ///< m2, by an exact union
    double floor = 0;       ///< m2
    std::vector<Point2> seen_apart;                  ///< the witnesses
    std::shared_ptr<const GuardCertificate> guards;  ///< the certificate, if one was wanted

    [[nodiscard]] bool isProven() const { return cover > 0 && cover == bound; }
    [[nodiscard]] std::string_view name() const override { return kOverPoses; }
    [[nodiscard]] bool replacesSearch() const override { return true; }
    [[nodiscard]] std::vector<Point2> witnesses() const override { return seen_apart; }
    [[nodiscard]] std::string finding(const ArrangeOptions& how,
                                      const Arrangement& arrangement) const override;
    [[nodiscard]] std::string shortfall(const Arrangement& arrangement) const override;
    [[nodiscard]] std::optional<Certificate> certificate(
        const std::vector<std::string>& history) const override;
};

/// A bound of the coverage over all poses, m2.
struct CoverageProof : public Proof {
    double found = 0;                   ///< seen by the layout, by exact area
    double bound = 0;                   ///< the same number of sensors, in any poses, sees no more
    double floor = 0;                   ///< the indoor floor
    std::size_t boxes = 0, tuples = 0;  ///< of poses, whose views were bounded
    std::shared_ptr<const PoseCertificate> trees;  ///< the certificate, if one was wanted

    [[nodiscard]] std::string_view name() const override { return kOverPoses; }
    [[nodiscard]] bool replacesSearch() const override { return false; }
    [[nodiscard]] std::optional<double> value() const override { return found / floor; }
    [[nodiscard]] std::string finding(const ArrangeOptions& how,
                                      const Arrangement& arrangement) const override;
    [[nodiscard]] std::optional<Certificate> certificate(
        const std::vector<std::string>& history) const override;
};

/// Proves over all poses: with a target the least number of sensors, else their coverage.
class PosesProver : public Prover {
  public:
    /// \param certifies keep certificates
    explicit PosesProver(bool certifies = false) : certifies_(certifies) {}

    [[nodiscard]] std::string_view name() const override { return kOverPoses; }
    [[nodiscard]] std::optional<Arrangement> arrange(const Scene& scene,
                                                     const std::vector<SensorGroup>& groups,
                                                     const ArrangeOptions& options,
                                                     Progress& progress) const override;
    void prove(CoverageModel& model, Arrangement& arrangement, Progress& progress) const override;

  private:
    bool certifies_;
};

/// Finds the fewest lasers that see the whole free floor at their height, over all poses, with a
/// FewestProof. \param certifies keep its certificate
/// \throws UsageError unless it is an art gallery: lasers of one kind that turn all around, level,
///         with a range beyond the room; straight walls; all of the floor as target
Arrangement arrangeOverPoses(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, bool certifies, Progress& progress);

/// Checks by other code that the lasers of a scene see its floor, and that fewer do not.
/// \throws UsageError as arrangeOverPoses() \throws FormatError as checkGuards()
GuardCheck checkGuarded(const Scene& scene, const GuardCertificate& certificate,
                        const std::string& name);

/// Gap at which a bound of coverage over all poses is close enough, unless another is given.
constexpr double kPosesGap = 0.005;

/// Divides zones into convex pieces of one weight.
poses::FloorWeighting weightingOf(const FloorWeights& weights);

/// Validates before a search that boundOfPoses() can follow it.
/// \throws UsageError unless the sensors are level lasers of one kind that stand alone in a room of
///         straight walls, few enough for the proof
void mustBeBoundable(const Scene& scene, const std::vector<SensorGroup>& groups,
                     const ArrangeOptions& options);

/// Bounds the coverage of the arranged sensors over all poses (CoverageProof), and moves them if a
/// better layout is found on the way. \param certifies keep its certificate
void boundOfPoses(CoverageModel& model, Arrangement& arrangement, bool certifies,
                  Progress& progress);

/// A bound of coverage over all poses that was checked, m2.
struct CheckedPoses {
    std::size_t sensors = 0;
    double found = 0;  ///< seen by the sensors of the scene, by exact area and weight
    double floor = 0;  ///< all that counts
    CertificateCheck check;
};

/// Checks a certificate for the sensors of a scene: computes all areas anew, by other code than
/// that of the search, but the area of the layout by weight, or that several sensors see, as
/// refinement does.
/// \param weights, times the goal of its search
/// \throws UsageError unless these are level lasers of one kind, as for mustBeBoundable()
/// \throws FormatError as checkCertificate()
CheckedPoses checkPoses(const Scene& scene, const FloorWeights& weights, int times,
                        const PoseCertificate& certificate, const std::string& name);

}  // namespace ispace::proofs
