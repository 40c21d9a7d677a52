// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/problem.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "support/test_problems.h"

namespace ispace {
namespace mps_file_test {

/// Stores the numbers of a model file; missing ones are 0.
struct Model {
    std::map<std::pair<std::string, std::string>, double> entries;  ///< column, row
    std::map<std::string, double> limits;                           ///< row
    std::map<std::string, double> upper;                            ///< column
    std::vector<std::string> rows, whole;                           ///< integer columns
};

Model modelOf(const Problem& problem, const std::vector<std::string>& kinds) {
    std::stringstream file;
    writeMps(
        problem, kinds, "number", [](const Choice& c) { return std::to_string(c.candidate); },
        file);
    Model model;
    std::string line, section;
    bool is_whole = false;
    while (std::getline(file, line)) {
        if (line.empty() || line[0] == '*') continue;
        std::istringstream words(line);
        if (line[0] != ' ') {
            words >> section;
            continue;
        }
        std::string first, second, third;
        words >> first >> second;
        if (section == "ROWS") {
            model.rows.push_back(second);
        } else if (second == "'MARKER'") {
            words >> third;
            is_whole = third == "'INTORG'";
        } else if (section == "COLUMNS") {
            words >> model.entries[{first, second}];
            if (is_whole && (model.whole.empty() || model.whole.back() != first))
                model.whole.push_back(first);
        } else if (section == "RHS") {
            words >> model.limits[second];
        } else {
            words >> third >> model.upper[third];
            model.upper[second] = 1;
        }
    }
    EXPECT_EQ(section, "ENDATA");
    return model;
}

Problem smallProblem(const CandidateSet& set) {
    Problem problem;
    problem.weights = {5, 6, 7, 0, 9};
    problem.achieved = {0, 1, 0, 0, 0};
    problem.kinds = {{&set, 2, 1.5, 1}};
    return problem;
}

CandidateSet smallSet() {
    CandidateSet set(5);
    CellSet left(5), right(5);
    for (const std::size_t i : {0U, 1U, 2U}) left.set(i);
    for (const std::size_t i : {2U, 3U}) right.set(i);
    set.addSite(left);
    set.addSite(right);
    return set;
}

TEST(WriteMps, HasTheNumbersOfASmallProblem) {
    const CandidateSet set = smallSet();
    Problem problem = smallProblem(set);
    problem.budget = 4.5;
    const Model model = modelOf(problem, {"laser"});
    // Cell 1 is met, cell 3 has no weight, cell 4 is unseen.
    EXPECT_EQ(model.rows, (std::vector<std::string>{"minus_value", "cell_0", "cell_2", "most_laser",
                                                    "budget"}));
    EXPECT_EQ(model.whole, (std::vector<std::string>{"x_laser_0", "x_laser_1"}));
    const std::map<std::pair<std::string, std::string>, double> entries = {
        {{"x_laser_0", "most_laser"}, 1},
        {{"x_laser_0", "budget"}, 1.5},
        {{"x_laser_0", "cell_0"}, -1},
        {{"x_laser_0", "cell_2"}, -1},
        {{"x_laser_1", "most_laser"}, 1},
        {{"x_laser_1", "budget"}, 1.5},
        {{"x_laser_1", "cell_2"}, -1},
        {{"y_0", "minus_value"}, -5},
        {{"y_0", "cell_0"}, 1},
        {{"y_2", "minus_value"}, -7},
        {{"y_2", "cell_2"}, 1}};
    EXPECT_EQ(model.entries, entries);
    EXPECT_EQ(model.limits, (std::map<std::string, double>{{"most_laser", 2}, {"budget", 4.5}}));
}

TEST(WriteMps, WithADemandCellsAreWhole) {
    const CandidateSet set = smallSet();
    Problem problem = smallProblem(set);
    problem.required = 5;
    problem.kinds[0].multiplicity = 4;
    Model model = modelOf(problem, {"laser"});
    EXPECT_EQ(model.whole.size(), 5U);  // two candidates, three cells
    EXPECT_EQ((model.entries[{"y_0", "cell_0"}]), 5);
    EXPECT_EQ((model.entries[{"x_laser_0", "cell_0"}]), -4);
    EXPECT_EQ((model.entries[{"y_1", "cell_1"}]), 4);
    EXPECT_EQ((model.entries[{"x_laser_0", "cell_1"}]), -4);
}

TEST(WriteMps, AllChoicesOfARandomProblemAreWorthTheSame) {
    for (std::uint64_t round = 0; round < 24; ++round) {
        const RandomProblem random = variedProblem(round);
        const Problem& problem = random.problem;
        std::vector<std::string> names;
        for (std::size_t k = 0; k < problem.kinds.size(); ++k)
            names.push_back(k == 0 ? "first" : "second");
        const Model model = modelOf(problem, names);
        std::vector<Choice> chosen;
        for (std::size_t k = 0; k < problem.kinds.size(); ++k)
            if (problem.kinds[k].candidates->size() > 1) chosen.push_back({k, round % 2});
        std::map<std::string, double> achieved;
        for (const auto& [place, number] : model.entries)
            for (const Choice& choice : chosen)
                if (place.first ==
                    "x_" + names[choice.kind] + "_" + std::to_string(choice.candidate))
                    achieved[place.second] -= number;
        double value = static_cast<double>(valueOf(problem, {}));
        for (const auto& [place, number] : model.entries) {
            if (place.second == "minus_value" || place.first[0] != 'y') continue;
            if (achieved[place.second] >= number)
                value -= model.entries.at({place.first, "minus_value"});
        }
        EXPECT_EQ(value, static_cast<double>(valueOf(problem, chosen))) << round;
    }
}

}  // namespace mps_file_test
}  // namespace ispace
