// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors of kinds that extensions add, behind one type, so that the list of kinds does not name
// them. A call costs a virtual function; parameters never change once they are stored, and copies
// share them.
//
//     struct Thermopile { std::string model; double max_range = 5; /* ... */ };
//     const SensorModel model = modelOf(Thermopile());
//     const Thermopile* const same = tryModel<Thermopile>(model);
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "geom/pose.h"

namespace ispace {

struct SensorKind;

/// The parameters of a sensor of a kind that an extension adds, see addSensorKind().
///
/// They are a value with the members that those in kinds.h have, too: `model`, `max_range`,
/// `readingRate()`, `readingTime()`, `rays()`, `isNoisy()`, `isOmnidirectional(mount)`, `==` and
/// `kKind`. Sensor::as<Parameters>() finds them as it finds those of the list. Copies share them.
class AddedSensor {
  public:
    template <typename Parameters>
    requires(!std::is_same_v<Parameters, AddedSensor>) explicit AddedSensor(Parameters parameters)
        : model(parameters.model),
          max_range(parameters.max_range),
          kind_(&Parameters::kKind),
          held_(std::make_shared<const Held<Parameters>>(std::move(parameters))) {}

    std::string model;
    double max_range = 0;  ///< limits its field of view, too

    [[nodiscard]] const SensorKind& kind() const { return *kind_; }
    /// Returns null for those of another kind.
    template <typename Parameters>
    [[nodiscard]] const Parameters* tryAs() const {
        if (kind_ != &Parameters::kKind) return nullptr;
        return &static_cast<const Held<Parameters>&>(*held_).value;
    }
    [[nodiscard]] double readingRate() const { return held_->readingRate(); }
    [[nodiscard]] double readingTime() const { return held_->readingTime(); }
    [[nodiscard]] std::size_t rays() const { return held_->rays(); }
    [[nodiscard]] bool isNoisy() const { return held_->isNoisy(); }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return held_->isOmnidirectional(mount);
    }
    friend bool operator==(const AddedSensor& a, const AddedSensor& b) {
        return a.model == b.model && a.max_range == b.max_range && a.kind_ == b.kind_ &&
               (a.held_ == b.held_ || a.held_->equals(*b.held_));
    }
    static const SensorKind kKind;  ///< of no sensor: a row for the list of kinds

  private:
    struct Any {
        virtual ~Any() = default;
        [[nodiscard]] virtual double readingRate() const = 0;
        [[nodiscard]] virtual double readingTime() const = 0;
        [[nodiscard]] virtual std::size_t rays() const = 0;
        [[nodiscard]] virtual bool isNoisy() const = 0;
        [[nodiscard]] virtual bool isOmnidirectional(const Pose3& mount) const = 0;
        /// \pre the other one is of the same kind
        [[nodiscard]] virtual bool equals(const Any& other) const = 0;
    };
    template <typename Parameters>
    struct Held final : Any {
        explicit Held(Parameters parameters) : value(std::move(parameters)) {}
        [[nodiscard]] double readingRate() const override { return value.readingRate(); }
        [[nodiscard]] double readingTime() const override { return value.readingTime(); }
        [[nodiscard]] std::size_t rays() const override { return value.rays(); }
        [[nodiscard]] bool isNoisy() const override { return value.isNoisy(); }
        [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const override {
            return value.isOmnidirectional(mount);
        }
        [[nodiscard]] bool equals(const Any& other) const override {
            return value == static_cast<const Held&>(other).value;
        }
        Parameters value;
    };

    const SensorKind* kind_;
    std::shared_ptr<const Any> held_;
};

}  // namespace ispace
