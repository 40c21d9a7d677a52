// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/token.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/error.h"
#include "base/file.h"

namespace ispace {

std::string readToken(const std::string& file) {
    constexpr std::size_t kMost = 256;
    std::string token = readAll(file);
    token.resize(std::min(token.size(), token.find('\n')));
    if (token.ends_with('\r')) token.pop_back();
    const bool plain = std::all_of(token.begin(), token.end(),
                                   [](unsigned char c) { return c > ' ' && c < 0x7f; });
    if (token.empty() || token.size() > kMost || !plain)
        throw FormatError({file, 1, 0,
                           "no token: wanted a line of 1 to 256 letters, digits and signs, without "
                           "blanks, as `openssl rand -hex 16` prints it"});
    return token;
}

bool isOpenToOthers(const std::string& file) {
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0)
        throw std::system_error(errno, std::generic_category(), file);
    return S_ISREG(info.st_mode) && (info.st_mode & (S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH)) != 0;
}

bool isSameSecret(std::string_view given, std::string_view secret) {
    // volatile: no early end once they differ
    volatile unsigned different = given.size() == secret.size() ? 0U : 1U;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const auto a = static_cast<unsigned char>(given[i]);
        const auto b = static_cast<unsigned char>(secret[i % secret.size()]);
        different = different | static_cast<unsigned>(a ^ b);
    }
    return different == 0;
}

}  // namespace ispace
