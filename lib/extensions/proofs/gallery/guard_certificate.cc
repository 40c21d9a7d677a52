// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a certificate of guards: witnesses with all digits, and trees node by node.
// Untrusted: counts are bounded.
#include "extensions/proofs/gallery/guard_certificate.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "base/number.h"
#include "extensions/proofs/certificate_lines.h"

namespace ispace::proofs {

namespace {

constexpr std::string_view kGuards = "guards ";
constexpr std::size_t kMaxWitnesses = 100'000, kMaxNodes = 100'000;

/// Removes the first word, up to a separator.
std::string_view takeWord(std::string_view& line, char separator) {
    const std::size_t end = line.find(separator);
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end == line.npos ? line.size() : end + 1);
    return word;
}

template <typename Number>
std::optional<Number> wholeOf(std::string_view word) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
}

GuardCertificate::Node nodeOf(std::string_view line, const CertificateLines& lines) {
    GuardCertificate::Node node;
    const std::string_view kind = takeWord(line, ' ');
    node.is_leaf = kind == "leaf";
    if (!node.is_leaf && kind != "pair") lines.refuse("wanted `leaf ROW:WEIGHT ...` or `pair A B`");
    if (!node.is_leaf) {
        const auto a = wholeOf<std::uint32_t>(takeWord(line, ' '));
        const auto b = wholeOf<std::uint32_t>(takeWord(line, ' '));
        if (!a || !b || *a == *b || !line.empty()) lines.refuse("wanted two witnesses of a pair");
        node.pair = {*a, *b};
    }
    while (!line.empty()) {
        std::string_view word = takeWord(line, ' ');
        const auto row = wholeOf<std::uint32_t>(takeWord(word, ':'));
        const auto weight = wholeOf<std::int64_t>(word);
        if (!row || !weight || *weight <= 0 || *weight > GuardCertificate::kUnit ||
            (!node.weights.empty() && *row <= node.weights.back().first))
            lines.refuse("wanted `ROW:WEIGHT`, rows ascending, weights of 1 to " +
                         std::to_string(GuardCertificate::kUnit));
        node.weights.emplace_back(*row, *weight);
    }
    return node;
}

void addNode(const GuardCertificate::Node& node, std::string& text) {
    text += node.is_leaf ? "leaf" : "pair";
    if (!node.is_leaf)
        for (const std::uint32_t witness : node.pair)
            text.append(" ").append(std::to_string(witness));
    for (const auto& [row, weight] : node.weights)
        text.append(" ").append(std::to_string(row)).append(":").append(std::to_string(weight));
    text += '\n';
}

}  // namespace

std::string certificateText(const GuardCertificate& certificate,
                            const std::vector<std::string>& history) {
    std::string text = certificateHead(history);
    text.append(kGuards).append(std::to_string(certificate.bound)) += "\nwitnesses\n";
    for (const Point2 p : certificate.witnesses)
        text.append(formatDouble(p.x)).append(" ").append(formatDouble(p.y)) += '\n';
    for (const GuardCertificate::Tree& tree : certificate.trees) {
        text += "tree\n";
        for (const GuardCertificate::Node& node : tree) addNode(node, text);
    }
    return text;
}

std::string weaknessOf(const GuardCertificate& certificate, std::size_t needed) {
    if (certificate.bound >= needed) return {};
    return "the certificate proves that " + std::to_string(certificate.bound) +
           " sensors are needed, not " + std::to_string(needed) +
           ": more would take too many branches";
}

bool isOfGuards(std::string_view certificate) {
    while (certificate.starts_with('#')) {
        const std::size_t end = certificate.find('\n');
        if (end == certificate.npos) return false;
        certificate.remove_prefix(end + 1);
    }
    return certificate.starts_with(kGuards);
}

GuardCertificate readGuardCertificate(std::string_view text, const std::string& name) {
    CertificateLines lines(text, name);
    const std::string_view first = lines.next();
    const auto bound = first.starts_with(kGuards)
                           ? wholeOf<std::size_t>(first.substr(kGuards.size()))
                           : std::nullopt;
    if (!bound || *bound == 0) lines.refuse("wanted `guards NUMBER`, at least 1");
    GuardCertificate certificate;
    certificate.bound = *bound;
    if (lines.next() != "witnesses") lines.refuse("wanted `witnesses`");
    while (!lines.atEnd() && lines.peek() != "tree") {
        std::string_view line = lines.next();
        const auto x = parseDouble(takeWord(line, ' ')), y = parseDouble(line);
        if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y)) lines.refuse("wanted `X Y`");
        if (certificate.witnesses.size() == kMaxWitnesses) lines.refuse("too many witnesses");
        certificate.witnesses.push_back({*x, *y});
    }
    for (std::size_t nodes = 0; !lines.atEnd(); ++nodes) {
        const std::string_view line = lines.next();
        if (nodes == kMaxNodes) lines.refuse("too many nodes");
        if (line == "tree")
            certificate.trees.emplace_back();
        else if (certificate.trees.empty())
            lines.refuse("wanted `tree`");
        else
            certificate.trees.back().push_back(nodeOf(line, lines));
    }
    if (certificate.trees.empty()) lines.refuse("proves no guards: wanted `tree`");
    return certificate;
}

}  // namespace ispace::proofs
