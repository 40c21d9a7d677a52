// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/run_files.h"
#include "io/exporters.h"
#include "io/glb/glb_file.h"
#include "io/glb/glb_read.h"
#include "io/importers.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Extracts extras and bufferViews of the top level from glTF's JSON as it streams by. It builds no
/// tree and does not recurse, so neither size nor nesting of a hostile file matters; parsing stops
/// once both are known.
class Finder : public nlohmann::json_sax<nlohmann::json> {
  public:
    struct View {
        std::uint64_t buffer = 0, offset = 0, length = 0;
    };
    /// The mesh of a file, by the buffer views that hold it.
    struct FileMesh {
        std::string digest;
        std::uint64_t positions = kWrong, indices = kWrong;
    };
    std::optional<std::uint64_t> records;  ///< extras.ispace
    std::vector<FileMesh> files;           ///< extras.ispace_meshes
    std::vector<View> views;
    std::size_t error_position = 0;

    /// Replaces a value that is not a whole number from 0 on: beyond any file.
    static constexpr std::uint64_t kWrong = std::numeric_limits<std::uint64_t>::max();

    /// Reads the JSON. \return false if the part that was parsed has errors
    bool read(std::string_view json) {
        return nlohmann::json::sax_parse(json.begin(), json.end(), this) || isComplete();
    }

    bool null() override { return take(kWrong); }
    bool boolean(bool /*value*/) override { return take(kWrong); }
    bool number_integer(number_integer_t /*value*/) override { return take(kWrong); }
    bool number_unsigned(number_unsigned_t value) override { return take(value); }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
        return take(kWrong);
    }
    bool string(string_t& value) override {
        if (inFileMesh() && key_ == "digest") files.back().digest = value;
        return take(kWrong);
    }
    bool binary(binary_t& /*value*/) override { return take(kWrong); }

    bool key(string_t& name) override {
        (depth_ == 1 ? section_ : key_) = name;
        if (depth_ == 2) member_ = name;
        return true;
    }
    bool start_object(std::size_t /*size*/) override {
        ++depth_;
        if (depth_ == 3 && section_ == "bufferViews") views.emplace_back();
        if (inFileMesh()) files.emplace_back();
        return true;
    }
    bool start_array(std::size_t /*size*/) override {
        ++depth_;
        return true;
    }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        error_position = position;
        return false;
    }

  private:
    [[nodiscard]] bool isComplete() const { return records && has_views_; }
    /// True in an object of the list extras.ispace_meshes.
    [[nodiscard]] bool inFileMesh() const {
        return depth_ == 4 && section_ == "extras" && member_ == "ispace_meshes";
    }

    bool take(std::uint64_t value) {
        if (depth_ == 2 && section_ == "extras" && key_ == "ispace") records = value;
        if (depth_ == 3 && section_ == "bufferViews" && !views.empty()) {
            if (key_ == "buffer") views.back().buffer = value;
            if (key_ == "byteOffset") views.back().offset = value;
            if (key_ == "byteLength") views.back().length = value;
        }
        if (inFileMesh() && !files.empty()) {
            if (key_ == "positions") files.back().positions = value;
            if (key_ == "indices") files.back().indices = value;
        }
        return true;
    }

    /// Returns false once all values are found, to stop the parser.
    bool close() {
        --depth_;
        if (depth_ == 1 && section_ == "bufferViews") has_views_ = true;
        return depth_ != 1 || !isComplete();
    }

    std::size_t depth_ = 0;
    std::string section_, member_, key_;
    bool has_views_ = false;
};

/// The binary data of a file.
class GlbData {
  public:
    virtual ~GlbData() = default;
    [[nodiscard]] virtual std::uint64_t size() const = 0;
    /// \pre the range lies within; the result is valid as long as this object
    [[nodiscard]] virtual std::string_view read(std::uint64_t offset, std::size_t length) = 0;
};

class DataInMemory final : public GlbData {
  public:
    explicit DataInMemory(std::string_view bytes) : bytes_(bytes) {}
    [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
    [[nodiscard]] std::string_view read(std::uint64_t offset, std::size_t length) override {
        return bytes_.substr(offset, length);
    }

  private:
    std::string_view bytes_;
};

/// A file with records, and the contents of its buffer views.
class Glb {
  public:
    /// \param json a prefix that holds the positions of the records
    Glb(std::string_view json, std::unique_ptr<GlbData> data, const std::string& name)
        : name_(name), data_(std::move(data)), is_sound_(finder_.read(json)) {}
    Glb(const GlbChunks& chunks, const std::string& name)
        : Glb(chunks.json, std::make_unique<DataInMemory>(chunks.binary), name) {
        if (!is_sound_)
            failFile(name, "damaged: bad JSON at byte " + std::to_string(finder_.error_position) +
                               " of its chunk");
    }

    /// Returns false if the given part of the JSON has errors or is too short.
    [[nodiscard]] bool isSound() const { return is_sound_; }
    [[nodiscard]] bool hasRecords() const { return finder_.records.has_value(); }
    [[nodiscard]] std::string_view records() {
        return viewOf(*finder_.records, "extras.ispace", "the records lie");
    }

    /// Sets the content of file records from the meshes stored in this file.
    void attachMeshes(std::vector<Record>& records) {
        for (Record& record : records) {
            if (record.keyword() != "mesh") continue;
            const std::string digest = record.has("digest") ? record.text("digest") : "";
            const auto [place, is_new] = meshes_.try_emplace(digest);
            if (is_new) place->second = meshOf(digest);
            if (place->second == nullptr)
                throw FormatError(record.finding(
                    "digest", "damaged: the content of `" + record.text("file") +
                                  "` is not in the file; compile the environment anew"));
            record.setMesh(place->second);
        }
    }

  private:
    [[nodiscard]] bool isWithin(const Finder::View& view) const {
        return view.buffer == 0 && view.offset <= data_->size() &&
               view.length <= data_->size() - view.offset;
    }

    [[nodiscard]] std::string_view viewOf(std::uint64_t index, const std::string& key,
                                          const std::string& content) {
        if (index >= finder_.views.size())
            failFile(name_, "damaged: " + key + " names none of the " +
                                std::to_string(finder_.views.size()) + " buffer views");
        const Finder::View& view = finder_.views[index];
        if (!isWithin(view))
            failFile(name_, "damaged: " + content + " outside of its " +
                                std::to_string(data_->size()) + " bytes of data");
        return data_->read(view.offset, view.length);
    }

    /// Copies a view of three numbers each.
    template <typename T>
    void readTriples(std::uint64_t view, std::vector<std::array<T, 3>>& out) {
        const std::string_view bytes = viewOf(view, "extras.ispace_meshes", "a mesh lies");
        if (bytes.size() % sizeof out[0] != 0)
            failFile(name_, "damaged: " + std::to_string(bytes.size()) +
                                " bytes of a mesh, wanted 12 each for points and triangles");
        // Otherwise views could overlap, and meshes take many times the file's size.
        taken_ += bytes.size();
        if (taken_ > data_->size()) failFile(name_, "damaged: its meshes overlap");
        out.resize(bytes.size() / sizeof out[0]);
        if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    }

    /// Returns the mesh with this digest; null if the file lacks it.
    std::shared_ptr<const TriangleMesh> meshOf(const std::string& digest) {
        const auto file =
            std::find_if(finder_.files.begin(), finder_.files.end(),
                         [&](const Finder::FileMesh& f) { return f.digest == digest; });
        if (digest.empty() || file == finder_.files.end()) return nullptr;
        const auto mesh = std::make_shared<TriangleMesh>();
        readTriples(file->positions, mesh->vertices);
        readTriples(file->indices, mesh->triangles);
        const auto is_bad = [](float number) { return !std::isfinite(number); };
        const auto is_beyond = [&mesh](std::uint32_t i) { return i >= mesh->vertices.size(); };
        for (const auto& point : mesh->vertices)
            if (std::any_of(point.begin(), point.end(), is_bad))
                failFile(name_, "damaged: a mesh has a point that is no number");
        for (const auto& corners : mesh->triangles)
            if (std::any_of(corners.begin(), corners.end(), is_beyond))
                failFile(name_, "damaged: a triangle of a mesh has a corner beyond its " +
                                    std::to_string(mesh->vertices.size()) + " points");
        mesh->digest = meshDigest(*mesh);
        if (mesh->digest != digest)
            failFile(name_, "damaged: the content of a mesh has another digest than " + digest);
        return mesh;
    }

    const std::string& name_;
    Finder finder_;
    std::unique_ptr<GlbData> data_;
    bool is_sound_;
    std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
    std::size_t taken_ = 0;  ///< bytes of meshes read
};

}  // namespace

bool isGlb(std::string_view bytes) { return bytes.starts_with("glTF"); }

namespace {

Glb glbOf(std::string_view bytes, const std::string& name) {
    if (!isGlb(bytes)) failFile(name, "not a binary glTF file: wanted `glTF` at its beginning");
    return {glbChunks(bytes, name), name};
}

Document documentOf(Glb& glb, const std::string& name, const Schemas& schemas) {
    Document document = readRecordText(glb.records(), name, schemas);
    glb.attachMeshes(document.records);
    return document;
}

/// Reads ranges of an open file.
class FileRanges {
  public:
    explicit FileRanges(RegularFile file, std::string name)
        : file_(std::move(file)), name_(std::move(name)) {}
    [[nodiscard]] std::uint64_t size() const { return file_.size; }
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Reads a range, up to the end of the file. \throws std::system_error
    [[nodiscard]] std::string read(std::uint64_t offset, std::size_t length) const {
        std::string bytes(offset < size() ? std::min<std::uint64_t>(length, size() - offset) : 0,
                          '\0');
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t count = ::pread(file_.file.fd(), bytes.data() + done, bytes.size() - done,
                                          static_cast<off_t>(offset + done));
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) throw std::system_error(errno, std::generic_category(), name_);
            if (count == 0) bytes.resize(done);  // truncated meanwhile
            done += static_cast<std::size_t>(count);
        }
        return bytes;
    }

  private:
    RegularFile file_;
    std::string name_;
};

/// Byte ranges of the JSON and binary chunks in a file with just these two.
struct GlbSpan {
    std::uint64_t json_end = 0, binary = 0, binary_size = 0;
};

constexpr std::size_t kGlbHead = 20, kChunkHead = 8;  // of the file with its first chunk; of others

std::optional<GlbSpan> spanOf(const FileRanges& file, std::string_view head) {
    const auto word = [](std::string_view bytes, std::size_t index) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + sizeof(value) * index, sizeof(value));
        return value;
    };
    if (head.size() < kGlbHead || word(head, 1) != 2 || word(head, 2) != file.size() ||
        head.substr(16, 4) != "JSON")
        return std::nullopt;
    GlbSpan span;
    span.json_end = kGlbHead + std::uint64_t{word(head, 3)};
    const std::string next = file.read(span.json_end, kChunkHead);
    if (next.size() < kChunkHead || next.substr(4) != std::string_view("BIN\0", 4))
        return std::nullopt;
    span.binary = span.json_end + kChunkHead;
    span.binary_size = word(next, 0);
    if (span.binary + span.binary_size != file.size()) return std::nullopt;
    return span;
}

class DataInFile final : public GlbData {
  public:
    DataInFile(FileRanges file, std::uint64_t offset, std::uint64_t size)
        : file_(std::move(file)), offset_(offset), size_(size) {}
    [[nodiscard]] std::uint64_t size() const override { return size_; }
    [[nodiscard]] std::string_view read(std::uint64_t offset, std::size_t length) override {
        parts_.push_back(file_.read(offset_ + offset, length));
        if (parts_.back().size() < length) failFile(file_.name(), "truncated while it was read");
        return parts_.back();
    }

  private:
    FileRanges file_;
    std::uint64_t offset_, size_;
    std::deque<std::string> parts_;  // bytes read so far; a deque keeps their addresses
};

}  // namespace

bool glbHasRecords(std::string_view bytes) {
    try {
        return glbOf(bytes, "").hasRecords();
    } catch (const FormatError&) {
        return true;  // readGlb() reports the error
    }
}

Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas) {
    Glb glb = glbOf(bytes, name);
    if (!glb.hasRecords())
        failFile(name,
                 "no ispace records in this glTF file: compile the environment with `envc … -o "
                 "room.glb`");
    return documentOf(glb, name, schemas);
}

namespace {

/// Opens a compiled file of records. \param file outlives the result
std::optional<Glb> openRoom(const std::string& file) {
    std::error_code ignored;
    if (!mayBeRead(file) || !std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
    FileRanges ranges(openRegular(file), file);
    if (!isGlb(ranges.read(0, kGlbHead))) return std::nullopt;
    // Files of ours begin with the records; a mesh of a file takes some hundred bytes.
    constexpr std::size_t kBeginning = 1 << 16;
    const std::string head = ranges.read(0, kBeginning);
    const auto span = spanOf(ranges, head);
    if (!span) return std::nullopt;
    const std::string_view json =
        std::string_view(head).substr(kGlbHead, span->json_end - kGlbHead);
    Glb glb(json, std::make_unique<DataInFile>(std::move(ranges), span->binary, span->binary_size),
            file);
    if (!glb.isSound() || !glb.hasRecords() || !isRecordText(glb.records())) return std::nullopt;
    return glb;
}

}  // namespace

std::optional<Document> readGlbFile(const std::string& file, const Schemas& schemas) {
    auto glb = openRoom(file);
    if (!glb) return std::nullopt;
    return documentOf(*glb, file, schemas);
}

bool isGlbRoom(const std::string& file) { return openRoom(file).has_value(); }

std::optional<std::string> glbOtherText(std::string_view bytes) {
    if (!isGlb(bytes)) return std::nullopt;
    const std::string name;
    try {
        Glb glb = glbOf(bytes, name);
        if (!glb.hasRecords() || isRecordText(glb.records())) return std::nullopt;
        return std::string(glb.records());
    } catch (const FormatError&) {
        return std::nullopt;  // readGlb() reports the error
    }
}

void attachGlbMeshes(std::string_view bytes, const std::string& name,
                     std::vector<Record>& records) {
    glbOf(bytes, name).attachMeshes(records);
}

}  // namespace ispace
