// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scan/options.h"
#include "sense/reading_run.h"

namespace ispace {

/// Where readings go: one stream, a set of files, or one cloud.
class Delivery {
  public:
    virtual ~Delivery() = default;
    [[nodiscard]] virtual Packing how() const = 0;
    /// What it keeps of the readings it may take out of them.
    virtual void write(Readings& readings) = 0;
    /// All is written.
    virtual void commit() = 0;
};

/// \param count readings there will be; negative: nobody knows
/// \throws UsageError where one file is named for several readings of a format that cannot hold
/// them
std::unique_ptr<Delivery> makeDelivery(const ScanToolOptions& options, const Sensors& sensors,
                                       const ReadingFormat& format, std::int64_t count);

}  // namespace ispace
