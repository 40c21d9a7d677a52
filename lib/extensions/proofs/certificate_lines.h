// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs: the lines that all certificates have in common. Uses base alone.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace ispace::proofs {

constexpr std::string_view kCertificateMagic = "#certificate 1";

/// Returns the first lines of a certificate: its version and, as comments, its history.
inline std::string certificateHead(const std::vector<std::string>& history) {
    std::string text(kCertificateMagic);
    text += '\n';
    for (const std::string& line : history) text.append("# ").append(line) += '\n';
    return text;
}

/// Reads the lines of a certificate after its head, and counts them.
class CertificateLines {
  public:
    /// \param name of the file, in errors
    /// \throws FormatError for another version
    CertificateLines(std::string_view text, const std::string& name) : rest_(text), name_(name) {
        if (next() != kCertificateMagic)
            refuse("not a certificate of this version: wanted " + std::string(kCertificateMagic));
        while (peek().starts_with('#')) next();
    }

    [[nodiscard]] bool atEnd() const { return rest_.empty(); }
    [[nodiscard]] std::string_view peek() const { return rest_.substr(0, rest_.find('\n')); }
    std::string_view next() {
        const std::string_view line = peek();
        rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
        ++number_;
        return line;
    }
    /// Throws a FormatError about the last line read.
    [[noreturn]] void refuse(const std::string& message) const {
        throw FormatError({name_, number_, 0, message});
    }

  private:
    std::string_view rest_;
    const std::string& name_;
    int number_ = 0;
};

}  // namespace ispace::proofs
