// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/p2os_packet.h"

#include <algorithm>
#include <cassert>

namespace ispace {

namespace {

constexpr char kFirst = '\xFA', kSecond = '\xFB';
/// FA, FB and the length; then id and checksum at least.
constexpr std::size_t kHead = 3, kLeast = 3, kChecksum = 2;
/// What a length may say at most.
constexpr std::size_t kMost = 200;
constexpr std::uint8_t kNegative = 0x1B;

unsigned byteAt(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

}  // namespace

std::uint16_t p2osChecksum(std::string_view body) {
    unsigned sum = 0;
    std::size_t i = 0;
    for (; i + 1 < body.size(); i += 2) sum += byteAt(body, i) << 8U | byteAt(body, i + 1);
    sum &= 0xFFFFU;
    if (i < body.size()) sum ^= byteAt(body, i);
    return static_cast<std::uint16_t>(sum);
}

std::string p2osBytes(std::uint8_t id, std::string_view data) {
    assert(data.size() <= kMaxP2osData);
    std::string body(1, static_cast<char>(id));
    body += data;
    const std::uint16_t sum = p2osChecksum(body);
    std::string bytes = {kFirst, kSecond, static_cast<char>(body.size() + kChecksum)};
    bytes += body;
    bytes += static_cast<char>(sum >> 8U);
    bytes += static_cast<char>(sum & 0xFFU);
    return bytes;
}

void P2osParser::append(std::string_view bytes) { bytes_ += bytes; }

std::optional<P2osPacket> P2osParser::take() {
    std::size_t at = 0;
    std::optional<P2osPacket> packet;
    while (!packet) {
        at = std::min(bytes_.find(kFirst, at), bytes_.size());
        const std::string_view rest = std::string_view(bytes_).substr(at);
        if (rest.size() > 1 && rest[1] != kSecond) {
            ++at;
            continue;
        }
        if (rest.size() < kHead) break;
        const std::size_t length = byteAt(rest, 2);
        if (length < kLeast || length > kMost) {
            ++at;
            continue;
        }
        if (rest.size() < kHead + length) break;
        const std::string_view body = rest.substr(kHead, length - kChecksum);
        const std::size_t sum = kHead + body.size();
        const unsigned wanted = byteAt(rest, sum) << 8U | byteAt(rest, sum + 1);
        if (p2osChecksum(body) == wanted) {
            packet = P2osPacket{static_cast<std::uint8_t>(body[0]), std::string(body.substr(1))};
            at += kHead + length;
        } else {
            ++at;
        }
    }
    drop(at);
    return packet;
}

void P2osParser::skip() {
    if (!bytes_.empty()) drop(1);
}

P2osWriter& P2osWriter::number(std::int64_t value, int bytes) {
    auto rest = static_cast<std::uint64_t>(value);
    for (int i = 0; i < bytes; ++i, rest >>= 8U) data_ += static_cast<char>(rest & 0xFFU);
    return *this;
}

std::int32_t p2osInteger(std::string_view data, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= byteAt(data, at + i) << (8 * i);
    const auto unused = static_cast<unsigned>(8 * (sizeof value - bytes));
    return static_cast<std::int32_t>(value << unused) >> unused;
}

std::optional<int> p2osNumber(const P2osPacket& command) {
    constexpr std::size_t kSize = 3;
    if (command.data.size() < kSize) return std::nullopt;
    const int magnitude = p2osInteger(command.data, 1, 2) & 0xFFFF;
    return byteAt(command.data, 0) == kNegative ? -magnitude : magnitude;
}

}  // namespace ispace
