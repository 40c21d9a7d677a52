// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/facet_index.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ispace {

/// A built Embree scene of a soup: facet i is primitive i of geometry 0. ROBUST, high quality, and
/// queries may have a filter.
///
/// Each scene has a device of its own: one costs some 50 microseconds, and a scene then shares
/// nothing with others that threads may be building, and leaves nothing behind.
class EmbreeScene {
  public:
    /// \throws std::runtime_error if Embree fails
    explicit EmbreeScene(const FacetSoup& soup);

    [[nodiscard]] RTCSceneTy* get() const { return scene_.get(); }
    /// Number of rays that the processor traces together: 16, 8, 4 or 1.
    [[nodiscard]] int widestPacket() const;

  private:
    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };
    void addGeometry(const FacetSoup& soup);

    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace ispace
