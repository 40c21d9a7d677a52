// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/packed_search.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <unordered_map>

#include "base/random.h"

namespace ispace {

namespace {

/// Numbers objects in the order of their first use.
class Numbering {
  public:
    /// Returns its number; calls `add` for a new object.
    template <typename Add>
    std::uint64_t of(const void* thing, Add add) {
        const auto [at, is_new] = numbers_.emplace(thing, numbers_.size());
        if (is_new) add();
        return at->second;
    }

  private:
    std::unordered_map<const void*, std::uint64_t> numbers_;
};

using List = std::vector<std::uint32_t>;

/// Returns true for strictly ascending numbers below `end`.
bool isAscending(const List& list, std::size_t end) {
    return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end() &&
           (list.empty() || list.back() < end);
}

void pack(Packer& to, const CandidateSet& set) {
    to.add(set.cells());
    to.add(set.sites());
    std::vector<CandidateSet::PartRange> ranges;
    for (std::size_t site = 0; site < set.sites(); ++site) {
        ranges.clear();
        for (std::size_t i = set.firstOf(site); i < set.firstOf(site + 1); ++i)
            ranges.push_back(set.rangeOf(i));
        to.addAll(ranges);
        CellParts parts;
        for (std::size_t part = 0; part <= set.directedParts(site); ++part) {
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
            const std::vector<CellRun> runs = set.runsOf(site, part);
            parts.runs.insert(parts.runs.end(), runs.begin(), runs.end());
        }
        parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        to.addAll(parts.runs);
        to.addAll(parts.first);
    }
}

std::shared_ptr<const CandidateSet> unpackSet(Unpacker& from, std::size_t cells) {
    if (from.number() != cells) Unpacker::refuse();
    const auto set = std::make_shared<CandidateSet>(cells);
    for (std::uint64_t sites = from.number(); sites > 0; --sites) {
        const auto ranges = from.all<CandidateSet::PartRange>();
        CellParts parts;
        parts.runs = from.all<CellRun>();
        parts.first = from.all<std::uint32_t>();
        if (ranges.empty() || !isWhole(parts, cells)) Unpacker::refuse();
        for (const CandidateSet::PartRange& range : ranges)
            if (range.begin > parts.size() - 1 || range.count > parts.size() - 1)
                Unpacker::refuse();
        set->addSite(ranges, parts);
    }
    return set;
}

void pack(Packer& to, const ReducedProblem& problem) {
    to.add(problem.settled);
    to.addAll(problem.weights);
    to.addAll(problem.needs);
    to.add(problem.kinds.size());
    for (const ReducedProblem::OfKind& kind : problem.kinds) {
        to.add(kind.multiplicity);
        to.addAll(kind.original);
        pack(to, *kind.candidates);
    }
}

std::shared_ptr<const ReducedProblem> unpackProblem(Unpacker& from, const Problem& original) {
    const auto problem = std::make_shared<ReducedProblem>();
    problem->settled = from.number();
    problem->weights = from.all<std::uint32_t>();
    problem->needs = from.all<std::uint16_t>();
    if (problem->needs.size() != problem->cells() || from.number() != original.kinds.size())
        Unpacker::refuse();
    for (const SensorType& kind : original.kinds) {
        ReducedProblem::OfKind& own = problem->kinds.emplace_back();
        const std::uint64_t multiplicity = from.number();
        if (multiplicity == 0 || multiplicity > UINT16_MAX) Unpacker::refuse();
        own.multiplicity = static_cast<std::uint16_t>(multiplicity);
        own.original = from.all<std::uint32_t>();
        own.candidates = unpackSet(from, problem->cells());
        if (own.candidates->size() != own.original.size() ||
            !isAscending(own.original, kind.candidates->size()))
            Unpacker::refuse();
    }
    return problem;
}

/// Data that nodes share, in the order of its numbers.
struct SharedParts {
    std::vector<std::shared_ptr<const ReducedProblem>> problems;
    std::vector<std::shared_ptr<const List>> lists;
};

template <typename T>
const T& at(const std::vector<T>& things, std::uint64_t number) {
    if (number >= things.size()) Unpacker::refuse();
    return things[number];
}

/// Returns true if the fixed choices and full groups are within the limits of the problem.
bool isWithinLimits(const Problem& problem, const BranchNode& node) {
    std::size_t most = 0;
    for (const SensorType& kind : problem.kinds)
        most += static_cast<std::size_t>(std::max(kind.most, 0));
    std::vector<Choice> all = node.fixed;
    for (const BranchGroup& group : node.groups) {
        if (all.size() > most || group.count > most - all.size()) return false;
        all.resize(all.size() + group.count, {group.kind, 0});
    }
    return isWithinLimits(problem, all);
}

BranchNode unpackNode(Unpacker& from, const SharedParts& shared, const Problem& original) {
    BranchNode node;
    node.problem = at(shared.problems, from.number());
    node.multipliers = at(shared.lists, from.number());
    if (node.multipliers->size() != node.problem->cells()) Unpacker::refuse();
    node.fixed = unpackChoices(from, original);
    node.bound = from.number();
    const auto check = [&](std::uint64_t kind, std::uint64_t candidate) {
        if (candidate >= at(node.problem->kinds, kind).original.size()) Unpacker::refuse();
    };
    for (std::uint64_t pending = from.number(); pending > 0; --pending) {
        const std::uint64_t kind = from.number(), candidate = from.number();
        check(kind, candidate);
        node.pending.push_back({kind, candidate});
    }
    for (std::uint64_t groups = from.number(); groups > 0; --groups) {
        const std::uint64_t kind = from.number(), count = from.number();
        const auto& list = at(shared.lists, from.number());
        if (!isAscending(*list, at(node.problem->kinds, kind).original.size()) ||
            count > list->size())
            Unpacker::refuse();
        node.groups.push_back({kind, count, list});
    }
    if (!isWithinLimits(original, node)) Unpacker::refuse();
    return node;
}

}  // namespace

std::uint64_t fingerprintOf(const Problem& problem) {
    std::uint64_t hash = mixedBits(problem.cells());
    const auto add = [&hash](std::uint64_t number) { hash = mixedBits(hash ^ number); };
    for (const std::uint32_t weight : problem.weights) add(weight);
    for (const std::uint16_t times : problem.achieved) add(times);
    for (const SensorType& kind : problem.kinds) {
        for (const int number : {kind.most, kind.multiplicity}) add(static_cast<unsigned>(number));
        add(kind.candidates->size());
        add(kind.candidates->runs());
        add(std::bit_cast<std::uint64_t>(kind.cost));
    }
    add(std::bit_cast<std::uint64_t>(problem.budget.value_or(-1)));
    add(static_cast<unsigned>(problem.required));
    add(problem.is_connected ? 1 : 0);
    for (const std::uint32_t region : problem.regions) add(region);
    for (const std::size_t kind : problem.order) add(kind);
    return hash;
}

void pack(Packer& to, const std::vector<Choice>& chosen) {
    to.add(chosen.size());
    for (const Choice& choice : chosen) {
        to.add(choice.kind);
        to.add(choice.candidate);
    }
}

std::vector<Choice> unpackChoices(Unpacker& from, const Problem& problem) {
    std::vector<Choice> chosen;
    for (std::uint64_t count = from.number(); count > 0; --count) {
        const std::uint64_t kind = from.number(), candidate = from.number();
        if (candidate >= at(problem.kinds, kind).candidates->size()) Unpacker::refuse();
        chosen.push_back({kind, candidate});
    }
    return chosen;
}

void pack(Packer& to, const SearchResult& result) {
    to.add(result.best.value);
    pack(to, result.best.chosen);
    to.add(result.bound);
    to.add(result.is_complete ? 1 : 0);
}

SearchResult unpackResult(Unpacker& from, const Problem& problem) {
    SearchResult result;
    result.best.value = from.number();
    result.best.chosen = unpackChoices(from, problem);
    result.bound = from.number();
    result.is_complete = from.number() != 0;
    const Solution& best = result.best;
    if (!isFeasible(problem, best.chosen) || best.value != valueOf(problem, best.chosen) ||
        result.bound < best.value)
        Unpacker::refuse();
    return result;
}

void pack(Packer& to, const Bound& bound) {
    to.add(bound.value);
    to.addAll(bound.multipliers);
    to.add(bound.scale);
    to.add(bound.survivors.size());
    for (const List& list : bound.survivors) to.addAll(list);
    to.add(bound.cut);
}

Bound unpackBound(Unpacker& from, const Problem& problem) {
    Bound bound;
    bound.value = from.number();
    bound.multipliers = from.all<std::uint32_t>();
    bound.scale = static_cast<std::uint32_t>(from.number());
    const std::uint64_t kinds = from.number();
    // None, or one list for each kind: RootRelaxation::keepOnly() reads all.
    if (kinds != 0 && kinds != problem.kinds.size()) Unpacker::refuse();
    for (std::uint64_t k = 0; k < kinds; ++k) {
        bound.survivors.push_back(from.all<std::uint32_t>());
        if (!isAscending(bound.survivors.back(), problem.kinds[k].candidates->size()))
            Unpacker::refuse();
    }
    bound.cut = from.number();
    const RelaxedCells cells(problem);
    if (bound.scale != cells.scale || bound.multipliers.size() != problem.cells() ||
        !std::equal(bound.multipliers.begin(), bound.multipliers.end(), cells.weights.begin(),
                    std::less_equal<>()))
        Unpacker::refuse();
    return bound;
}

void pack(Packer& to, const std::vector<const BranchNode*>& nodes) {
    Packer problems, lists, own;
    Numbering problem_numbers, list_numbers;
    std::uint64_t problem_count = 0, list_count = 0;
    const auto number_of = [&](const std::shared_ptr<const List>& list) {
        return list_numbers.of(list.get(), [&] {
            lists.addAll(*list);
            ++list_count;
        });
    };
    for (const BranchNode* node : nodes) {
        own.add(problem_numbers.of(node->problem.get(), [&] {
            pack(problems, *node->problem);
            ++problem_count;
        }));
        own.add(number_of(node->multipliers));
        pack(own, node->fixed);
        own.add(node->bound);
        pack(own, node->pending);
        own.add(node->groups.size());
        for (const BranchGroup& group : node->groups) {
            own.add(group.kind);
            own.add(group.count);
            own.add(number_of(group.list));
        }
    }
    to.add(problem_count);
    to.add(list_count);
    to.add(nodes.size());
    to.addBytes(problems.bytes());
    to.addBytes(lists.bytes());
    to.addBytes(own.bytes());
}

std::vector<BranchNode> unpackNodes(Unpacker& from, const Problem& problem) {
    const std::uint64_t problems = from.number(), lists = from.number(), count = from.number();
    SharedParts shared;
    for (std::uint64_t i = 0; i < problems; ++i)
        shared.problems.push_back(unpackProblem(from, problem));
    for (std::uint64_t i = 0; i < lists; ++i)
        shared.lists.push_back(std::make_shared<const List>(from.all<std::uint32_t>()));
    std::vector<BranchNode> nodes;
    for (std::uint64_t i = 0; i < count; ++i) nodes.push_back(unpackNode(from, shared, problem));
    return nodes;
}

}  // namespace ispace
