// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/digest.h"

#include <openssl/evp.h>

#include <array>
#include <memory>
#include <stdexcept>

#include "record/text.h"

namespace ispace {

namespace {

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
    }
    void add(std::string_view bytes) {
        check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
    }
    std::string finish() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned size = 0;
        check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
        constexpr std::string_view kDigits = "0123456789abcdef";
        std::string text = "sha256:";
        for (unsigned i = 0; i < size; ++i) {
            text += kDigits[digest[i] >> 4U];
            text += kDigits[digest[i] & 15U];
        }
        return text;
    }

  private:
    static void check(bool success) {
        if (!success) throw std::runtime_error("OpenSSL cannot make a SHA-256 digest");
    }
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

/// A record of a loaded file with the digest of its content in place of the file's name and of
/// where files that it names may be.
/// \pre it is loaded
Record byContent(Record record) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File || key.name == "side_files") record.erase(key.name);
    record.set("digest", record.mesh()->digest);
    return record;
}

}  // namespace

std::string meshDigest(const TriangleMesh& mesh) {
    Sha256 digest;
    const auto add = [&digest](const auto& items) {
        digest.add({reinterpret_cast<const char*>(items.data()), items.size() * sizeof items[0]});
    };
    add(mesh.vertices);
    add(mesh.triangles);
    return digest.finish();
}

std::string sha256(std::string_view bytes) {
    Sha256 digest;
    digest.add(bytes);
    return digest.finish();
}

std::string environmentDigest(std::span<const Record> records) {
    constexpr std::size_t kBlock = 1 << 16;
    Sha256 digest;
    std::string text;
    for (const Record& record : records) {
        if (!record.schema().isEnvironment()) continue;
        if (record.mesh() == nullptr)
            appendRecord(text, record);
        else
            appendRecord(text, byContent(record));
        text += '\n';
        if (text.size() < kBlock) continue;
        digest.add(text);
        text.clear();
    }
    digest.add(text);
    return digest.finish();
}

}  // namespace ispace
