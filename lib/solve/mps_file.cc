// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/mps_file.h"

#include <algorithm>
#include <cassert>

#include "base/number.h"

namespace ispace {
namespace {

/// One problem on its way into a file. Lines are gathered in one string, as there are many.
class MpsWriter {
  public:
    MpsWriter(const Problem& problem, const std::vector<std::string>& kinds, std::ostream& out)
        : problem_(problem), names_(kinds), out_(out), lacks_(problem.cells(), 0) {
        std::vector<char> is_seen(problem.cells(), 0);
        for (const Kind& kind : problem.kinds)
            for (std::size_t i = 0; i < kind.candidates->size(); ++i)
                kind.candidates->forEachRun(i, [&is_seen](const CellRun& run) {
                    std::fill(is_seen.begin() + run.first, is_seen.begin() + run.end, char{1});
                });
        for (std::size_t cell = 0; cell < lacks_.size(); ++cell) {
            const int achieved = problem.achieved.empty() ? 0 : problem.achieved[cell];
            if (achieved >= problem.required)
                achieved_already_ += problem.weights[cell];
            else if (is_seen[cell] != 0 && problem.weights[cell] > 0)
                lacks_[cell] = problem.required - achieved;
        }
    }
    void write(const std::string& legend,
               const std::function<std::string(const Choice&)>& describe) {
        writeComments(legend, describe);
        writeRows();
        line({"COLUMNS"});
        line({"    MARKER 'MARKER' 'INTORG'"});
        for (std::size_t k = 0; k < names_.size(); ++k)
            for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
                writeSensor(k, i);
        if (problem_.required == 1) line({"    MARKER 'MARKER' 'INTEND'"});
        writeCells();
        if (problem_.required != 1) line({"    MARKER 'MARKER' 'INTEND'"});
        writeLimits();
        line({"ENDATA"});
        flush();
    }

  private:
    void line(std::initializer_list<std::string_view> parts) {
        for (const std::string_view part : parts) text_ += part;
        text_ += '\n';
        if (text_.size() > 1U << 16U) flush();
    }
    void flush() {
        out_ << text_;
        text_.clear();
    }
    [[nodiscard]] std::string nameOf(std::size_t kind, std::size_t candidate) const {
        std::string name = "x_";
        name += names_[kind];
        name += '_';
        name += std::to_string(candidate);
        return name;
    }
    void writeComments(const std::string& legend,
                       const std::function<std::string(const Choice&)>& describe);
    void writeRows();
    void writeSensor(std::size_t kind, std::size_t candidate);
    void writeCells();
    void writeLimits();

    const Problem& problem_;
    const std::vector<std::string>& names_;
    std::ostream& out_;
    std::string text_;
    std::vector<int> lacks_;  ///< multiplicity still required of each cell; 0: left out
    std::uint64_t achieved_already_ = 0;
};

void MpsWriter::writeComments(const std::string& legend,
                              const std::function<std::string(const Choice&)>& describe) {
    line(
        {"* Where sensors see most. y_CELL is 1 if the cell is covered, x_KIND_INDEX if a sensor"});
    line({"* stands there. The objective is to be minimised: the value is ",
          std::to_string(achieved_already_), " minus the objective."});
    line({"* The weights of all cells together: ", std::to_string(problem_.totalWeight())});
    if (problem_.is_connected)
        line({"* That the views hang together is not part of this model: its value is a bound."});
    line({"* Candidate: ", legend});
    for (std::size_t k = 0; k < names_.size(); ++k)
        for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
            line({"* ", nameOf(k, i), ": ", describe({k, i})});
}

void MpsWriter::writeRows() {
    line({"NAME coverage"});
    line({"ROWS"});
    line({" N minus_value"});
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell)
        if (lacks_[cell] > 0) line({" L cell_", std::to_string(cell)});
    for (const std::string& name : names_) line({" L most_", name});
    if (problem_.budget) line({" L budget"});
}

/// Coefficients are capped at what the cell lacks: the same integer solutions, a tighter model.
void MpsWriter::writeSensor(std::size_t kind, std::size_t candidate) {
    const Kind& own = problem_.kinds[kind];
    const std::string name = nameOf(kind, candidate);
    line({"    ", name, " most_", names_[kind], " 1"});
    if (problem_.budget) line({"    ", name, " budget ", formatDouble(own.cost)});
    own.candidates->forEachRun(candidate, [&](const CellRun& run) {
        for (std::uint32_t cell = run.first; cell < run.end; ++cell)
            if (lacks_[cell] > 0)
                line({"    ", name, " cell_", std::to_string(cell), " -",
                      std::to_string(std::min(own.multiplicity, lacks_[cell]))});
    });
}

void MpsWriter::writeCells() {
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell) {
        if (lacks_[cell] == 0) continue;
        const std::string number = std::to_string(cell);
        line({"    y_", number, " minus_value -", std::to_string(problem_.weights[cell])});
        line({"    y_", number, " cell_", number, " ", std::to_string(lacks_[cell])});
    }
}

void MpsWriter::writeLimits() {
    line({"RHS"});
    for (std::size_t k = 0; k < names_.size(); ++k)
        line(
            {"    RHS most_", names_[k], " ", std::to_string(std::max(problem_.kinds[k].most, 0))});
    if (problem_.budget) line({"    RHS budget ", formatDouble(*problem_.budget)});
    line({"BOUNDS"});
    for (std::size_t k = 0; k < names_.size(); ++k)
        for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
            line({" UP BOUND ", nameOf(k, i), " 1"});
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell)
        if (lacks_[cell] > 0) line({" UP BOUND y_", std::to_string(cell), " 1"});
}

}  // namespace

void writeMps(const Problem& problem, const std::vector<std::string>& kinds,
              const std::string& legend, const std::function<std::string(const Choice&)>& describe,
              std::ostream& out) {
    assert(kinds.size() == problem.kinds.size());
    MpsWriter(problem, kinds, out).write(legend, describe);
}

}  // namespace ispace
