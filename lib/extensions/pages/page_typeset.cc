// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "extensions/pages/page_writer.h"

namespace ispace::pages {

namespace {

bool isWordByte(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-' || static_cast<unsigned char>(c) >= 0x80;
}

/// Replaces the unit behind a number, or alone: "12.00 m2", "indoor m2".
void typeset(std::string& text) {
    constexpr std::string_view kPlain = "m2", kTypeset = "m²";
    for (std::size_t at = text.find(kPlain); at != std::string::npos;
         at = text.find(kPlain, at + kTypeset.size())) {
        const std::size_t end = at + kPlain.size();
        const bool begins = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
        if (begins && (end == text.size() || !isWordByte(text[end])))
            text.replace(at, kPlain.size(), kTypeset);
    }
}

void typeset(TextRow& row) {
    for (std::string& cell : row) typeset(cell);
}

struct BlockTypesetter {
    void operator()(PageText& block) const { typeset(block.text); }
    void operator()(PageTable& table) const {
        typeset(table.caption);
        typeset(table.heads);
        for (TextRow& row : table.rows) typeset(row);
    }
    void operator()(PageCode& /*block*/) const {}
    void operator()(PageFigure& figure) const { typeset(figure.caption); }
    void operator()(PageMap& map) const { typeset(map.paper.caption); }
};

}  // namespace

ReportPage typeset(ReportPage page) {
    typeset(page.subtitle);
    for (PageSection& section : page.sections)
        for (PageBlock& block : section.blocks) std::visit(BlockTypesetter(), block);
    return page;
}

}  // namespace ispace::pages
