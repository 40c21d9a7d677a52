// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/scip.h"

#include <algorithm>
#include <utility>

namespace ispace {

namespace {

constexpr unsigned kSix = 0x3F, kZero = 0x30;
constexpr std::size_t kColumns = 64;
constexpr std::size_t kLongestText = 16;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool isOfText(char c) {
    return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ' ' || c == '.' ||
           c == '_' || c == '+' || c == '@';
}

}  // namespace

char scipCheck(std::string_view content) {
    unsigned sum = 0;
    for (const char c : content) sum += static_cast<unsigned char>(c);
    return static_cast<char>((sum & kSix) + kZero);
}

void appendScipNumber(std::string& out, std::uint32_t value, int characters) {
    for (int i = characters - 1; i >= 0; --i)
        out += static_cast<char>(((value >> (6U * static_cast<unsigned>(i))) & kSix) + kZero);
}

void appendScipLine(std::string& out, std::string_view content) {
    out += content;
    out += scipCheck(content);
    out += '\n';
}

void appendScipField(std::string& out, std::string_view key, std::string_view value) {
    const std::size_t begin = out.size();
    out.append(key).append(":").append(value);
    const char check = scipCheck(std::string_view(out).substr(begin));
    out += ';';
    out += check;
    out += '\n';
}

void appendScipData(std::string& out, std::string_view values) {
    for (std::size_t i = 0; i < values.size(); i += kColumns)
        appendScipLine(out, values.substr(i, kColumns));
}

std::optional<std::string> ScipLines::next() {
    for (std::size_t i = 0; i < bytes_.size(); ++i) {
        const char c = bytes_[i];
        if (c != '\n' && c != '\r') {
            if (line_.size() <= kLongest) line_ += c;
        } else if (!line_.empty()) {
            bytes_.erase(0, i + 1);
            return std::exchange(line_, {});
        }
    }
    bytes_.clear();
    return std::nullopt;
}

ScipRequest ScipRequest::of(std::string_view line) {
    ScipRequest request;
    const std::size_t semicolon = std::min(line.find(';'), line.size());
    request.text = line.substr(semicolon);
    const std::string_view body = line.substr(0, semicolon);
    const std::size_t letters = body.starts_with("SCIP2.0") ? 7 : body.starts_with("%") ? 3 : 2;
    request.command = body.substr(0, letters);
    request.parameters = body.substr(request.command.size());
    if (line.size() > ScipLines::kLongest) {
        request.fault = "0F";
    } else if (request.text.size() > kLongestText + 1) {
        request.fault = "0G";
    } else if (!request.text.empty() &&
               !std::all_of(request.text.begin() + 1, request.text.end(), isOfText)) {
        request.fault = "0H";
    }
    return request;
}

ScipSweep parseScipSweep(std::string_view parameters, bool streams, int last, std::string& status) {
    constexpr std::size_t kOfOne = 10, kOfStream = 13;
    ScipSweep sweep;
    const std::size_t length = streams ? kOfStream : kOfOne;
    if (parameters.size() != length) {
        status = parameters.size() < length ? "0C" : "0D";
        return sweep;
    }
    status = "00";
    const auto number = [&](std::size_t from, std::size_t size, std::string_view fault) {
        int value = 0;
        for (const char c : parameters.substr(from, size)) {
            if (!isDigit(c)) {
                if (status == "00") status = fault;
                return 0;
            }
            value = value * 10 + (c - '0');
        }
        return value;
    };
    sweep.start = number(0, 4, "01");
    sweep.end = number(4, 4, "02");
    sweep.cluster = std::max(1, number(8, 2, "03"));
    if (streams) {
        sweep.interval = number(10, 1, "06");
        sweep.count = number(11, 2, "07");
    }
    if (status != "00") return sweep;
    if (sweep.end > last)
        status = "04";
    else if (sweep.end < sweep.start)
        status = "05";
    return sweep;
}

}  // namespace ispace
