// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shard.h"

#include <algorithm>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

Shard::Block Shard::blockOf(std::int64_t units) const {
    const std::int64_t each = units / count, rest = units % count, before = index - 1;
    const std::int64_t first = before * each + std::min(before, rest);
    return {first, first + each + (before < rest ? 1 : 0)};
}

std::string Shard::text() const { return std::to_string(index) + '/' + std::to_string(count); }

Shard parseShard(const std::string& text) {
    const std::size_t slash = text.find('/');
    const auto index = parseInteger(text.substr(0, slash));
    const auto count =
        slash == std::string::npos ? std::nullopt : parseInteger(text.substr(slash + 1));
    if (!index || !count || *count < 1 || *count > kMaxShards || *index < 0)
        throw UsageError('`' + text +
                         "` is not I/N, the number of a shard and how many there are, " +
                         "such as 3/8 (at most " + std::to_string(kMaxShards) + ")");
    if (*index == 0)
        throw UsageError('`' + text + "`: shards are counted from 1, the first is 1/" +
                         std::to_string(*count));
    if (*index > *count)
        throw UsageError('`' + text + "`: there is no shard " + std::to_string(*index) + " of " +
                         std::to_string(*count));
    return {static_cast<int>(*index), static_cast<int>(*count)};
}

}  // namespace ispace
