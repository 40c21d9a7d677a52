// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/missing_keywords.h"

#include <map>

namespace ispace {

namespace {

std::map<std::string_view, std::string_view>& extensionsByKeyword() {
    static std::map<std::string_view, std::string_view> extensions;
    return extensions;
}

}  // namespace

void addMissingKeyword(std::string_view keyword, std::string_view extension) {
    extensionsByKeyword()[keyword] = extension;
}

std::string_view missingExtension(std::string_view keyword) {
    const auto found = extensionsByKeyword().find(keyword);
    return found == extensionsByKeyword().end() ? std::string_view() : found->second;
}

}  // namespace ispace
