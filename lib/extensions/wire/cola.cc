// SPDX-License-Identifier: GPL-3.0-or-later
// Telegrams of CoLa as bytes, see cola.h for the sources. Untrusted: a telegram has at most 1024
// bytes, and bytes that are none are skipped up to the next beginning.
#include "extensions/wire/cola.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace ispace::wire {

namespace {

constexpr char kBegin = 2, kEnd = 3;
constexpr std::string_view kBinaryBegin("\2\2\2\2", 4);
constexpr std::size_t kHeader = 8;
constexpr unsigned kByte = 8;

char checkOf(std::string_view content) {
    unsigned check = 0;
    for (const char c : content) check ^= static_cast<unsigned char>(c);
    return static_cast<char>(check);
}

void appendBytes(std::string& out, std::uint32_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i)
        out += static_cast<char>((value >> (kByte * static_cast<unsigned>(i))) & 0xFFU);
}

std::uint32_t numberIn(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char c : bytes) value = (value << kByte) | static_cast<unsigned char>(c);
    return value;
}

}  // namespace

/// Parses a telegram that starts with 02.
ColaTelegrams::Found ColaTelegrams::takeText(ColaTelegram& telegram) {
    const std::size_t end = bytes_.find_first_of("\2\3", 1);
    if (end == std::string::npos) {
        if (bytes_.size() <= kMaxLength) return Found::Nothing;
        bytes_.erase(0, 1);
        return Found::None;
    }
    if (bytes_[end] == kBegin || end - 1 > kMaxLength) {
        bytes_.erase(0, end);
        return Found::None;
    }
    telegram = {bytes_.substr(1, end - 1), false};
    bytes_.erase(0, end + 1);
    return Found::Telegram;
}

/// Parses a telegram that starts with two 02.
ColaTelegrams::Found ColaTelegrams::takeBinary(ColaTelegram& telegram) {
    const std::size_t known = std::min(bytes_.size(), kBinaryBegin.size());
    const bool begins = std::string_view(bytes_).substr(0, known) == kBinaryBegin.substr(0, known);
    if (begins && bytes_.size() < kHeader) return Found::Nothing;
    const std::size_t size =
        begins ? numberIn(std::string_view(bytes_).substr(kBinaryBegin.size(), 4)) : 0;
    if (!begins || size > kMaxLength) {
        bytes_.erase(0, 1);
        return Found::None;
    }
    if (bytes_.size() < kHeader + size + 1) return Found::Nothing;
    const std::string content = bytes_.substr(kHeader, size);
    if (bytes_[kHeader + size] != checkOf(content)) {
        bytes_.erase(0, 1);
        return Found::None;
    }
    telegram = {content, true};
    bytes_.erase(0, kHeader + size + 1);
    return Found::Telegram;
}

std::optional<ColaTelegram> ColaTelegrams::next() {
    ColaTelegram telegram;
    while (true) {
        bytes_.erase(0, std::min(bytes_.find(kBegin), bytes_.size()));
        if (bytes_.size() < 2) return std::nullopt;
        const Found found = bytes_[1] == kBegin ? takeBinary(telegram) : takeText(telegram);
        if (found == Found::Telegram) return telegram;
        if (found == Found::Nothing) return std::nullopt;
    }
}

std::string colaFrame(std::string_view content, bool is_binary) {
    std::string out;
    if (is_binary) {
        out = kBinaryBegin;
        appendBytes(out, static_cast<std::uint32_t>(content.size()), 4);
        return out.append(content) += checkOf(content);
    }
    out += kBegin;
    return out.append(content) += kEnd;
}

ColaWriter& ColaWriter::number(std::uint32_t value, int bytes) {
    if (is_binary_) {
        appendBytes(content_, value, bytes);
        return *this;
    }
    std::array<char, 8> digits{};
    const auto end = std::to_chars(digits.begin(), digits.end(), value, 16).ptr;
    content_ += ' ';
    for (auto digit = digits.begin(); digit != end; ++digit)
        content_ += *digit >= 'a' ? static_cast<char>(*digit - 'a' + 'A') : *digit;
    return *this;
}

ColaWriter& ColaWriter::f32(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    // Drivers look for eight digits here.
    if (!is_binary_ && bits == 0) return name("00000000");
    return u32(bits);
}

ColaWriter& ColaWriter::name(std::string_view text) {
    if (!is_binary_) content_ += ' ';
    content_ += text;
    return *this;
}

ColaWriter& ColaWriter::text(std::string_view text) {
    u16(static_cast<std::uint32_t>(text.size()));
    return name(text);
}

std::optional<std::int64_t> ColaReader::number(std::size_t bytes) {
    if (is_binary_) {
        if (rest_.size() < bytes) return std::nullopt;
        const std::uint32_t value = numberIn(rest_.substr(0, bytes));
        rest_.remove_prefix(bytes);
        return value;
    }
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    const bool is_decimal = word.starts_with('+') || word.starts_with('-');
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + word.size(), value, is_decimal ? 10 : 16);
    if (word.empty() || error != std::errc() || end != word.data() + word.size())
        return std::nullopt;
    return value;
}

std::optional<std::int64_t> ColaReader::i32() {
    const auto value = number(4);
    if (!value) return value;
    // FFF92230 is -450000.
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(*value));
}

}  // namespace ispace::wire
