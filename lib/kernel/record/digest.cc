// SPDX-License-Identifier: GPL-3.0-or-later
// The digest by which a layout knows its room.
#define OPENSSL_SUPPRESS_DEPRECATED

#include <openssl/sha.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "record/text.h"

namespace ispace {

namespace {

/// Computes sha256 by the deprecated functions of OpenSSL, which do not allocate. Their successors
/// read the OpenSSL configuration and crash if memory runs out meanwhile.
class Sha256 {
  public:
    Sha256() { SHA256_Init(&context_); }
    void add(std::string_view bytes) { SHA256_Update(&context_, bytes.data(), bytes.size()); }
    std::string finish() {
        std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
        SHA256_Final(digest.data(), &context_);
        constexpr std::string_view kDigits = "0123456789abcdef";
        std::string text = "sha256:";
        for (const unsigned char byte : digest) {
            text += kDigits[byte >> 4U];
            text += kDigits[byte & 15U];
        }
        return text;
    }

  private:
    SHA256_CTX context_{};
};

/// Removes the texture: it does not affect measurements, and its file name depends on the folder.
Record withoutPicture(Record record) {
    record.erase("texture");
    return record;
}

bool hasPicture(const Record& record) {
    return record.schema().find("texture") != nullptr && record.has("texture");
}

/// Replaces the file names of a record, and the folder rule of `side_files`, by the digest of the
/// loaded content.
/// \pre the record's file is loaded
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
    std::vector<const Record*> all;
    all.reserve(records.size());
    for (const Record& record : records) all.push_back(&record);
    return environmentDigest(all);
}

std::string environmentDigest(std::span<const Record* const> records) {
    constexpr std::size_t kBlock = 1 << 16;
    Sha256 digest;
    std::string text;
    for (const Record* const next : records) {
        const Record& record = *next;
        if (!record.schema().isEnvironment()) continue;
        if (record.mesh() != nullptr)
            appendRecord(text, byContent(record));
        else if (hasPicture(record))
            appendRecord(text, withoutPicture(record));
        else
            appendRecord(text, record);
        text += '\n';
        if (text.size() < kBlock) continue;
        digest.add(text);
        text.clear();
    }
    digest.add(text);
    return digest.finish();
}

}  // namespace ispace
