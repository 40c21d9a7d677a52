// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/arrange: proofs over more poses than the candidates of a search. The search itself
// proves a bound over its candidates; an extension implements these classes, see
// cli/proof_extension.h.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/sensor_group.h"
#include "base/error.h"
#include "geom/point.h"
#include "scene/scene.h"

namespace ispace {

struct Arrangement;
struct ArrangeOptions;
class CoverageModel;

/// A proof as a file.
struct Certificate {
    std::string text;
    std::string weakness;  ///< a warning if it proves less than was found; else empty
};

/// What was proven about a layout.
class Proof {
  public:
    virtual ~Proof() = default;

    /// Returns the word of its prover, for results.
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// Returns true if the layout is that of the proof, and no candidates were tried.
    [[nodiscard]] virtual bool replacesSearch() const = 0;
    /// Returns the share of the floor that the layout sees, by the measure of the proof; empty: by
    /// that of the search.
    [[nodiscard]] virtual std::optional<double> value() const { return {}; }
    /// Returns points of the floor that the layout is proven from, for results.
    [[nodiscard]] virtual std::vector<Point2> witnesses() const { return {}; }
    /// Says in words what is proven of the arrangement.
    [[nodiscard]] virtual std::string finding(const ArrangeOptions& how,
                                              const Arrangement& arrangement) const = 0;
    /// Says why a target is not reached. \pre replacesSearch()
    [[nodiscard]] virtual std::string shortfall(const Arrangement& /*arrangement*/) const {
        return "";
    }
    /// Returns the certificate, empty unless the prover keeps one.
    /// \param history lines of the layout
    [[nodiscard]] virtual std::optional<Certificate> certificate(
        const std::vector<std::string>& history) const = 0;

  protected:
    Proof() = default;
    Proof(const Proof&) = default;
    Proof& operator=(const Proof&) = default;
};

/// Proves layouts of a room alone. Constant while arrange() runs.
class Prover {
  public:
    virtual ~Prover() = default;

    /// Returns the word of --proof that asks for it.
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// Arranges without candidates, with Arrangement::proof, where the proof finds the layout
    /// itself; empty: search, and then prove().
    /// \throws UsageError for a room, sensors or options that the proof is not about
    [[nodiscard]] virtual std::optional<Arrangement> arrange(const Scene& scene,
                                                             const std::vector<SensorGroup>& groups,
                                                             const ArrangeOptions& options,
                                                             Progress& progress) const = 0;
    /// Proves a bound of the layout found (Arrangement::proof), and moves its sensors if a better
    /// layout is found on the way.
    virtual void prove(CoverageModel& model, Arrangement& arrangement,
                       Progress& progress) const = 0;

  protected:
    Prover() = default;
    Prover(const Prover&) = default;
    Prover& operator=(const Prover&) = default;
};

}  // namespace ispace
