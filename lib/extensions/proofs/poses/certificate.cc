// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a certificate: the bound with all digits, then both trees in lines of 100 characters.
#include "extensions/proofs/poses/certificate.h"

#include <algorithm>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "extensions/proofs/certificate_lines.h"

namespace ispace::proofs {

namespace {

constexpr std::string_view kBound = "bound ";
constexpr std::size_t kWidth = 100;  // of a line of a tree

struct Tree {
    std::string_view name, nodes;  // characters that it may hold
    std::string PoseCertificate::*text;
};
constexpr Tree kTrees[] = {{"boxes", "xyh.", &PoseCertificate::boxes},
                           {"tuples", "0123.-", &PoseCertificate::tuples}};

}  // namespace

std::string certificateText(const PoseCertificate& certificate,
                            const std::vector<std::string>& history) {
    std::string text = certificateHead(history);
    text.append(kBound).append(formatDouble(certificate.bound)) += '\n';
    for (const Tree& tree : kTrees) {
        text.append(tree.name) += '\n';
        const std::string& nodes = certificate.*tree.text;
        for (std::size_t i = 0; i < nodes.size(); i += kWidth)
            text.append(nodes, i, kWidth) += '\n';
    }
    return text;
}

PoseCertificate readCertificate(std::string_view text, const std::string& name) {
    CertificateLines lines(text, name);
    const std::string_view first = lines.next();
    const auto bound =
        first.starts_with(kBound) ? parseDouble(first.substr(kBound.size())) : std::nullopt;
    if (!bound || *bound < 0) lines.refuse("wanted `bound AREA` in square metres");
    PoseCertificate certificate{.bound = *bound, .boxes = {}, .tuples = {}};
    for (const Tree& tree : kTrees) {
        if (lines.next() != tree.name) lines.refuse("wanted `" + std::string(tree.name) + '`');
        std::string& nodes = certificate.*tree.text;
        const auto is_next = [&] {
            return std::any_of(std::begin(kTrees), std::end(kTrees),
                               [&](const Tree& other) { return lines.peek() == other.name; });
        };
        while (!lines.atEnd() && !is_next()) {
            const std::string_view line = lines.next();
            if (const auto wrong = line.find_first_not_of(tree.nodes); wrong != line.npos)
                lines.refuse("`" + printable(line.substr(wrong, 1)) + "` is no node of " +
                             std::string(tree.name) + ", which are " + std::string(tree.nodes));
            nodes += line;
        }
    }
    if (!lines.atEnd()) lines.refuse("more than two trees");
    return certificate;
}

}  // namespace ispace::proofs
