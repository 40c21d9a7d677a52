// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/script_lines.h"

#include <algorithm>
#include <utility>

#include "sim/command.h"

namespace ispace {

namespace {

struct MissingLine {
    std::string_view word, extension;
};

std::vector<ScriptLines>& kinds() {
    static std::vector<ScriptLines> known;
    return known;
}

std::vector<MissingLine>& missingLines() {
    static std::vector<MissingLine> known;
    return known;
}

}  // namespace

void addScriptLines(ScriptLines lines) {
    const bool is_known = std::any_of(kinds().begin(), kinds().end(), [&](const ScriptLines& kind) {
        return kind.words == lines.words;
    });
    if (!is_known) kinds().push_back(std::move(lines));
}

void addMissingScriptLine(std::string_view word, std::string_view extension) {
    missingLines().push_back({word, extension});
}

bool isDirectorsLine(std::string_view line) {
    const std::vector<Piece> pieces = wordsOf(line);
    return !pieces.empty() &&
           std::any_of(kinds().begin(), kinds().end(), [&](const ScriptLines& kind) {
               return std::find(kind.words.begin(), kind.words.end(), pieces.front().text) !=
                      kind.words.end();
           });
}

std::string_view missingScriptLine(std::string_view word) {
    for (const MissingLine& line : missingLines())
        if (line.word == word) return line.extension;
    return {};
}

std::vector<std::shared_ptr<Director>> readDirectors(std::string_view text, const std::string& file,
                                                     const World& world) {
    std::vector<std::shared_ptr<Director>> directors;
    for (const ScriptLines& kind : kinds())
        if (std::shared_ptr<Director> director = kind.read(text, file, world))
            directors.push_back(std::move(director));
    return directors;
}

}  // namespace ispace
