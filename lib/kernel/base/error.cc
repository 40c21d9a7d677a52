// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <array>
#include <utility>

namespace ispace {

namespace {

std::string firstLine(const std::vector<Diagnostic>& diagnostics) {
    return diagnostics.empty() ? std::string("bad data") : diagnostics.front().text();
}

}  // namespace

std::string_view nameOf(Severity severity) {
    constexpr std::array<std::string_view, 3> kNames{"error", "warning", "note"};
    return kNames[static_cast<std::size_t>(severity)];
}

std::string Diagnostic::place() const {
    std::string place = displayName(file);
    if (!place.empty() && line > 0) {
        place += ':' + std::to_string(line);
        if (column > 0) place += ':' + std::to_string(column);
    }
    return place.empty() ? "" : place + ": ";
}

std::string Diagnostic::text() const {
    return place().append(nameOf(severity)).append(": ").append(message);
}

FormatError::FormatError(Diagnostic diagnostic)
    : FormatError(std::vector<Diagnostic>{std::move(diagnostic)}) {}

FormatError::FormatError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(firstLine(diagnostics)), diagnostics_(std::move(diagnostics)) {}

void Diagnostics::add(Diagnostic diagnostic) {
    if (full())
        ++dropped_;
    else
        kept_.push_back(std::move(diagnostic));
}

void Diagnostics::add(const FormatError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) add(diagnostic);
}

void Diagnostics::throwIfAny() const {
    if (kept_.empty()) return;
    std::vector<Diagnostic> all = kept_;
    if (dropped_ > 0) {
        all.back().message += " (" + std::to_string(dropped_) + " more errors not shown)";
    }
    throw FormatError(std::move(all));
}

std::string displayName(std::string_view operand) {
    return operand == "-" ? "stdin" : std::string(operand);
}

}  // namespace ispace
