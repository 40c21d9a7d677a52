// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/picture_files.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "extensions/views/contact_sheet.h"
#include "raster/codec.h"

namespace ispace::views {

namespace {

void writeFile(const std::string& name, const std::string& bytes) {
    OutputFile file(name);
    file.write(bytes);
    file.commit();
}

std::string jpegOf(const Image& image) {
    std::vector<std::uint8_t> samples;
    samples.reserve(3 * image.pixels.size());
    for (const std::uint32_t pixel : image.pixels)
        for (const unsigned shift : {16U, 8U, 0U})
            samples.push_back(static_cast<std::uint8_t>(pixel >> shift));
    return jpegOfRgb(image.width, image.height, samples);
}

}  // namespace

PictureSize pictureSizeOf(const ViewSpec& view, const Scene& scene,
                          std::optional<PictureSize> wanted) {
    const PictureSize size = sizeOf(view, scene, wanted);
    constexpr double kMaxPixels = 64e6;
    if (1.0 * size.columns * size.rows > kMaxPixels)
        throw UsageError("--size: " + std::to_string(size.columns) + " x " +
                         std::to_string(size.rows) + " pixels, wanted at most 64 million");
    return size;
}

PictureFiles::PictureFiles(const CommonOptions& common, bool is_jpeg,
                           const std::vector<std::string>& names, int frames)
    : output_(common.output),
      set_(OutputSet::of(output_)),
      is_jpeg_(is_jpeg),
      files_([this](const Image& image) { return encoded(image); }, writeFile) {
    if (set_) {
        if (common.dependencies.wanted)
            throw UsageError("-MD writes a rule for one product, and a set is many files");
        set_->prepare(names, frames > 1, {ending()});
    } else if (frames > 1) {
        throw UsageError(std::to_string(frames) +
                         " frames make as many pictures: name a folder (-o DIR/) or a pattern "
                         "(-o '%s-%04d.png'), where %s is the view's name");
    } else {
        refuseTerminal(output_, is_jpeg ? "jpeg" : "png");
    }
}

std::function<void(double)> rowsOf(const PictureJob& job, Progress& progress) {
    // Shares are summed as whole numbers, in any order.
    constexpr double kParts = 1e9;
    return [done = std::make_shared<std::atomic<std::int64_t>>(0), &progress,
            rows = job.shape.rows](double share) {
        const auto part = static_cast<std::int64_t>(std::llround(kParts * share));
        const auto row_at = [&](std::int64_t parts) {
            return static_cast<std::int64_t>(rows * (static_cast<double>(parts) / kParts));
        };
        const std::int64_t before = done->fetch_add(part);
        if (const std::int64_t more = row_at(before + part) - row_at(before); more > 0)
            progress.advance(more);
    };
}

std::int64_t rowsOf(const std::vector<PictureJob>& jobs) {
    std::int64_t rows = 0;
    for (const PictureJob& job : jobs) rows += job.shape.rows;
    return rows;
}

void PictureFiles::write(const std::vector<PictureJob>& jobs, int frame, Progress& progress) {
    std::vector<PictureSize> sizes;
    sizes.reserve(jobs.size());
    for (const PictureJob& job : jobs) sizes.push_back(job.shape);
    const ContactSheet sheet(sizes);
    std::vector<Image> images;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        Image image = jobs[i].draw(set_ ? sizes[i] : sheet.sizeOf(i), rowsOf(jobs[i], progress));
        if (set_)
            files_.add(set_->fileOf(jobs[i].name, frame, ending()), std::move(image));
        else
            images.push_back(std::move(image));
        names.push_back(jobs[i].label);
    }
    if (!set_) writeFile(output_, encoded(sheet.draw(images, names)));
}

std::string PictureFiles::encoded(const Image& image) const {
    return is_jpeg_ ? jpegOf(image) : pngOfShades(image.width, image.height, image.pixels);
}

}  // namespace ispace::views
