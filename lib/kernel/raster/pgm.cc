// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "raster/picture.h"

namespace ispace {

namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

class PgmParser {
  public:
    PgmParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    GreyPicture parse() {
        const bool plain = readMagic();
        GreyPicture image;
        image.width = headerNumber("width", kMaxPgmPixels);
        image.height = headerNumber("height", kMaxPgmPixels);
        const std::int64_t pixels = std::int64_t{image.width} * image.height;
        if (pixels > kMaxPgmPixels)
            fail(std::to_string(image.width) + " x " + std::to_string(image.height) +
                 " pixels, wanted at most " + std::to_string(kMaxPgmPixels));
        image.max_value = headerNumber("maximum", 65535);
        const auto count = static_cast<std::size_t>(pixels);
        if (plain)
            readPlain(image, count);
        else
            readRaw(image, count);
        return image;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(Diagnostic{displayName(name_), 0, 0, message});
    }

    /// Reads the magic; returns true for P2.
    bool readMagic() {
        if (bytes_.empty()) fail("empty file, wanted a PGM picture (P2 or P5)");
        const std::string_view word = nextWord();
        // Quotes only a word as long as a magic: a map may name a file that is no picture.
        if (word != "P2" && word != "P5")
            fail("wrong magic" + (word.size() == 2 ? ' ' + excerpt(word) : "") +
                 ", wanted a PGM picture (P2 or P5)");
        return word == "P2";
    }

    /// Returns the next word between blanks and comments; empty at the end.
    std::string_view nextWord() {
        while (at_ < bytes_.size() && (isBlank(bytes_[at_]) || bytes_[at_] == '#')) {
            if (bytes_[at_] == '#') at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1);
            ++at_;
        }
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && !isBlank(bytes_[at_]) && bytes_[at_] != '#') ++at_;
        return bytes_.substr(begin, at_ - begin);
    }

    int headerNumber(const std::string& what, std::int64_t most) {
        const std::string_view word = nextWord();
        if (word.empty()) fail("truncated: the header ends before the " + what);
        const auto number = parseInteger(word);
        if (!number || *number < 1 || *number > most)
            fail("bad header: " + what + ' ' + excerpt(word) + ", wanted a number from 1 to " +
                 std::to_string(most));
        return static_cast<int>(*number);
    }

    void readPlain(GreyPicture& image, std::size_t count) {
        // A sample takes a digit and a blank, so the file size bounds the allocation.
        image.samples.reserve(std::min(count, (bytes_.size() - at_) / 2 + 1));
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view word = nextWord();
            if (word.empty())
                fail("truncated: " + std::to_string(i) + " of " + std::to_string(count) +
                     " samples");
            const auto sample = parseInteger(word);
            if (!sample || *sample < 0)
                fail("bad sample " + excerpt(word) + ", wanted a number from 0 to " +
                     std::to_string(image.max_value));
            addSample(image, *sample);
        }
        if (const std::string_view word = nextWord(); !word.empty())
            fail("more than " + std::to_string(count) + " samples: " + excerpt(word) +
                 " behind the last one");
    }

    void readRaw(GreyPicture& image, std::size_t count) {
        const std::size_t width = image.max_value > 255 ? 2 : 1;
        // Exactly one blank ends the header: the next byte may be a sample that looks like one.
        if (at_ < bytes_.size() && !isBlank(bytes_[at_]))
            fail("bad header: wanted one blank between the maximum and the samples");
        const std::string_view data = bytes_.substr(std::min(at_ + 1, bytes_.size()));
        if (data.size() != count * width)
            fail((data.size() < count * width ? "truncated: " : "too long: ") +
                 std::to_string(data.size()) + " of " + std::to_string(count * width) + " bytes");
        const auto byte = [data](std::size_t i) { return static_cast<unsigned char>(data[i]); };
        image.samples.reserve(count);
        for (std::size_t i = 0; i < data.size(); i += width)
            addSample(image, width == 1 ? byte(i) : byte(i) * 256 + byte(i + 1));
    }

    void addSample(GreyPicture& image, std::int64_t sample) const {
        if (sample > image.max_value)
            fail("sample " + std::to_string(sample) + " is above the maximum " +
                 std::to_string(image.max_value));
        image.samples.push_back(static_cast<std::uint16_t>(sample));
    }

    std::string_view bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

}  // namespace

GreyPicture parsePgm(std::string_view bytes, const std::string& name) {
    return PgmParser(bytes, name).parse();
}

}  // namespace ispace
