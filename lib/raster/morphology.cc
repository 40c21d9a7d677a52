// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/morphology.h"

#include <algorithm>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace ispace {

namespace {

/// Runs what OpenCV does in the calling thread alone, with its errors as ours.
template <typename Work>
auto withOpenCv(Work work) {
    try {
        static const bool is_alone = (cv::setNumThreads(1), true);
        static_cast<void>(is_alone);
        return work();
    } catch (const cv::Exception& error) {
        if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
        throw std::logic_error("OpenCV: " + error.err);
    }
}

/// The same memory; OpenCV takes what it does not write to as a matrix that it could.
cv::Mat matrixOf(const MapCells& cells) {
    return {cells.height(), cells.width(), CV_8UC1, const_cast<std::uint8_t*>(cells.data().data())};
}

/// Squares around a cell: `before` cells to the left of it and below. Beyond the grid is 0.
void erode(const cv::Mat& from, cv::Mat to, int side, int before) {
    cv::erode(from, to, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {before, before},
              1, cv::BORDER_CONSTANT, cv::Scalar(0));
}
void dilate(const cv::Mat& from, cv::Mat to, int side, int before) {
    cv::dilate(from, to, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {before, before},
               1, cv::BORDER_CONSTANT, cv::Scalar(0));
}

}  // namespace

MapCells opened(const MapCells& cells, int side) {
    return withOpenCv([&] {
        MapCells result(cells.width(), cells.height());
        const cv::Mat squares = matrixOf(result);
        erode(matrixOf(cells), squares, side, 0);
        dilate(squares, squares, side, side - 1);
        return result;
    });
}

MapCells grown(const MapCells& cells, int reach) {
    return withOpenCv([&] {
        MapCells result(cells.width(), cells.height());
        dilate(matrixOf(cells), matrixOf(result), 2 * reach + 1, reach);
        return result;
    });
}

std::vector<CellPlace> deepestPlaces(const MapCells& cells, const CellPieces& pieces) {
    return withOpenCv([&] {
        cv::Mat padded, depth;
        cv::copyMakeBorder(matrixOf(cells), padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
        cv::distanceTransform(padded, depth, cv::DIST_L1, cv::DIST_MASK_3);
        std::vector<CellPlace> places(pieces.size());
        std::vector<float> deepest(pieces.size());
        pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
            const auto* const row = depth.ptr<float>(run.row + 1) + 1;
            const auto* const best = std::max_element(row + run.first, row + run.last + 1);
            if (*best <= deepest[piece]) return;
            deepest[piece] = *best;
            places[piece] = {static_cast<int>(best - row), run.row};
        });
        return places;
    });
}

}  // namespace ispace
