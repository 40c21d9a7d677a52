// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "place/best_place.h"
#include "place/search_basis.h"

namespace ispace {

/// The best sensor to add to others.
struct Response {
    Choice choice;
    Score score = 0;
    bool is_found = false;
};

/// Best responses by what they answer to, shared by searches that run at the same time: those from
/// different starts meet. A response depends on its key alone, so who found it does not matter.
class ResponseCache {
  public:
    using Key = std::vector<Choice>;  ///< ascending

    [[nodiscard]] std::optional<Response> find(const Key& others) const;
    void store(const Key& others, const Response& response);

  private:
    mutable std::mutex mutex_;
    std::map<Key, Response> responses_;
};

/// Moves sensors one by one to where they add most to the others, until no move helps: value counts
/// first, then the parts of demands that are met, then lower cost.
class LocalSearch {
  public:
    LocalSearch(const SearchBasis& basis, ResponseCache& cache, Progress& progress)
        : basis_(basis), cache_(cache), progress_(progress) {}

    /// Adds the best sensor, again and again, while one may be added.
    void fill(CoverageState& state);
    /// To a local optimum, or until progress says stop. \pre the choices are feasible
    void improve(CoverageState& state);

  private:
    /// What is known of what each site can add: bounds that hold for these prices.
    struct SiteBounds {
        std::vector<std::uint32_t> prices;  ///< empty: any
        std::vector<std::uint32_t> bounds;
    };
    using Slot = std::vector<SiteBounds>;  ///< per kind

    Response respond(const CoverageState& others, Slot& slot, const std::optional<Response>& known);
    BestPlace bestOf(const CoverageState& others, std::size_t kind, SiteBounds& bounds,
                     const BestPlace& known);
    void renew(SiteBounds& known, std::size_t kind) const;
    Slot& slotAt(std::size_t position);
    bool move(CoverageState& state, std::size_t position);
    bool add(CoverageState& state);
    bool rebuy(CoverageState& state);
    bool rebuyWithout(CoverageState& state, const std::vector<std::size_t>& positions);

    const SearchBasis& basis_;
    ResponseCache& cache_;
    Progress& progress_;
    PlaceFinder finder_;
    std::vector<Slot> slots_;                          // by position, the last for all beyond
    std::vector<std::uint32_t> prices_, more_prices_;  // of the search under way
    CellPrices sums_, more_sums_;
};

}  // namespace ispace
