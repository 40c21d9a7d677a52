// SPDX-License-Identifier: GPL-3.0-or-later
// Lays out the segment and reserves its memory at once, since a later lack of memory would be a
// signal (SIGBUS) to both sides.
#include "extensions/learning/vector_segment.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"

namespace ispace::learning {

namespace {

constexpr std::size_t kPage = 4096, kLine = 64;

std::size_t roundedUp(std::size_t size, std::size_t unit) {
    return (size + unit - 1) / unit * unit;
}

/// Lays arrays out one after another.
class SegmentPlan {
  public:
    template <typename Number>
    void add(const char* name, Number*& pointer, const char* type,
             const std::vector<std::size_t>& shape) {
        std::size_t count = 1;
        std::string text = "[";
        for (const std::size_t side : shape) {
            count *= side;
            text += (text.size() > 1 ? ", " : "") + std::to_string(side);
        }
        json_ += (json_.empty() ? "" : ", ") + ("\"" + std::string(name)) +
                 "\": {\"offset\": " + std::to_string(kHead + size_) + ", \"shape\": " + text +
                 "], \"type\": \"" + type + "\"}";
        const std::size_t offset = kHead + size_;
        setters_.emplace_back([&pointer, offset](char* memory) {
            pointer = reinterpret_cast<Number*>(memory + offset);
        });
        size_ = roundedUp(size_ + count * sizeof(Number), kLine);
    }
    [[nodiscard]] const std::string& json() const { return json_; }
    [[nodiscard]] std::size_t size() const { return roundedUp(kHead + size_, kPage); }
    void bind(char* memory) const {
        for (const auto& set : setters_) set(memory);
    }
    static constexpr std::size_t kHead = kPage;

  private:
    std::string json_;
    std::size_t size_ = 0;
    std::vector<std::function<void(char*)>> setters_;
};

}  // namespace

std::string VectorSegment::checkedName(const std::string& text) {
    constexpr std::size_t kLongest = 200;
    constexpr const char* kLetters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
    if (text.empty() || text.size() > kLongest || text.front() == '.' ||
        text.find_first_not_of(kLetters) != std::string::npos)
        throw UsageError(excerpt(text) +
                         " is no name of a segment, wanted letters, digits, dots, - and _");
    return text;
}

VectorSegment::VectorSegment(const std::string& name, const LearningSetting& setting,
                             std::size_t worlds, const std::string& facts)
    : name_('/' + checkedName(name)) {
    const std::size_t rows = worlds * setting.robots(), width = setting.observation();
    SegmentPlan plan;
    plan.add("actions", arrays_.actions, "<f4", {rows, LearningWorld::kActions});
    plan.add("observations", arrays_.observations, "<f4", {BatchArrays::kBuffers, rows, width});
    plan.add("final_observations", arrays_.final_observations, "<f4", {rows, width});
    plan.add("rewards", arrays_.rewards, "<f8", {rows});
    plan.add("terminations", arrays_.terminations, "|b1", {rows});
    plan.add("truncations", arrays_.truncations, "|b1", {rows});
    plan.add("successes", arrays_.successes, "|b1", {rows});
    plan.add("collisions", arrays_.collisions, "|b1", {rows});
    plan.add("returns", arrays_.returns, "<f8", {rows});
    plan.add("lengths", arrays_.lengths, "<u4", {rows});
    plan.add("poses", arrays_.poses, "<f4", {rows, 3});
    plan.add("goals", arrays_.goals, "<f4", {rows, 2});
    plan.add("seeds", arrays_.seeds, "<u8", {worlds});
    plan.add("masks", arrays_.masks, "|u1", {worlds});
    description_ =
        "{\"schema\": \"ispace-vector/1\", " + facts + "\"arrays\": {" + plan.json() + "}}";
    const std::string head = "ispace-vector 1\n" + description_ + '\n';
    if (head.size() > SegmentPlan::kHead)
        throw std::logic_error("the head of a segment is too long");
    const auto fail = [&name](int error) {
        throw std::system_error(error, std::generic_category(), "/dev/shm/" + name);
    };
    const int file =
        shm_open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file < 0 && errno == EEXIST)
        throw UsageError("--shm: /dev/shm/" + name +
                         " is there already: another run uses it, or one that was killed left it");
    if (file < 0) fail(errno);
    size_ = plan.size();
    // Reserved now: a write to memory that is not there would end the process later.
    const int error = posix_fallocate(file, 0, static_cast<off_t>(size_));
    void* const memory =
        error != 0 ? MAP_FAILED : mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    const int map_error = errno;
    close(file);
    if (memory == MAP_FAILED) {
        shm_unlink(name_.c_str());
        fail(error != 0 ? error : map_error);
    }
    memory_ = static_cast<char*>(memory);
    plan.bind(memory_);
    std::memcpy(memory_, head.data(), head.size());
}

VectorSegment::~VectorSegment() {
    munmap(memory_, size_);
    shm_unlink(name_.c_str());  // the learner may have done so
}

}  // namespace ispace::learning
