// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef AVOID_GRID_MAP_H
#define AVOID_GRID_MAP_H

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace avoid {

/// The plan of a room in cells, as ROS has it (a YAML file and a picture, PGM), with the distance
/// from each cell to the nearest thing. Metres. Cells that are not known to be free count as
/// things.
class GridMap {
  public:
    /// \param path of the YAML file
    static GridMap read(const std::string& path) {
        std::ifstream file(path);
        if (!file) throw std::runtime_error("cannot read " + path);
        GridMap map;
        std::string picture, key;
        while (file >> key) {
            if (key == "image:") file >> picture;
            if (key == "resolution:") file >> map.cell_;
            if (key == "origin:") {
                char mark = 0;
                file >> mark >> map.origin_.x() >> mark >> map.origin_.y();
            }
        }
        if (picture.empty() || !(map.cell_ > 0)) throw std::runtime_error(path + " is no map");
        const std::size_t slash = path.rfind('/');
        if (slash != std::string::npos && picture[0] != '/')
            picture = path.substr(0, slash + 1) + picture;
        map.readCells(picture);
        map.measureDistances();
        return map;
    }

    /// How far it is from here to the nearest thing; 0 in things and outside.
    double clearance(const Eigen::Vector2d& at) const {
        const Eigen::Vector2d cells = (at - origin_) / cell_ - Eigen::Vector2d(0.5, 0.5);
        const int column = static_cast<int>(std::floor(cells.x()));
        const int row = static_cast<int>(std::floor(cells.y()));
        if (column < 0 || row < 0 || column + 1 >= columns_ || row + 1 >= rows_) return 0;
        const double u = cells.x() - column, v = cells.y() - row;
        const double below = (1 - u) * distance(column, row) + u * distance(column + 1, row);
        const double above =
            (1 - u) * distance(column, row + 1) + u * distance(column + 1, row + 1);
        return (1 - v) * below + v * above;
    }

    /// How far a ray goes; at most `longest`.
    double rayLength(const Eigen::Vector2d& from, double angle, double longest) const {
        const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
        // All obstacles are farther than the clearance, so the ray skips that length at once.
        for (double length = 0; length < longest;) {
            const double free = clearance(from + length * direction);
            if (free < cell_ / 2) return length;
            length += free;
        }
        return longest;
    }

    Eigen::Vector2d least() const { return origin_; }
    Eigen::Vector2d greatest() const { return origin_ + cell_ * Eigen::Vector2d(columns_, rows_); }

  private:
    void readCells(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        std::string magic;
        int most = 0;
        if (!(file >> magic >> columns_ >> rows_ >> most) || magic != "P5" || most != 255)
            throw std::runtime_error(path + " is no PGM of 8 bits");
        if (columns_ < 2 || rows_ < 2 || columns_ > 20000 || rows_ > 20000)
            throw std::runtime_error(path + " has a size that is no room's");
        file.get();
        distances_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        std::string line(static_cast<std::size_t>(columns_), '\0');
        // Pictures begin at the top, rooms at the bottom.
        for (int row = rows_ - 1; row >= 0; --row) {
            if (!file.read(&line[0], columns_)) throw std::runtime_error(path + " ends too early");
            for (int column = 0; column < columns_; ++column) {
                const auto grey =
                    static_cast<unsigned char>(line[static_cast<std::size_t>(column)]);
                const bool is_free = grey > 250;
                distances_[index(column, row)] = is_free ? kFar : 0;
            }
        }
    }

    /// Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions" (2012): squares of
    /// distances, first along the columns, then along the rows.
    void measureDistances() {
        std::vector<double> line;
        for (int column = 0; column < columns_; ++column) {
            line.clear();
            for (int row = 0; row < rows_; ++row) line.push_back(distances_[index(column, row)]);
            line = nearestSquares(line);
            for (int row = 0; row < rows_; ++row)
                distances_[index(column, row)] = line[static_cast<std::size_t>(row)];
        }
        for (int row = 0; row < rows_; ++row) {
            const auto begin = distances_.begin() + static_cast<std::ptrdiff_t>(index(0, row));
            line.assign(begin, begin + columns_);
            line = nearestSquares(line);
            for (std::size_t i = 0; i < line.size(); ++i)
                line[i] = cell_ * std::max(0.0, std::sqrt(line[i]) - 0.5);
            std::copy(line.begin(), line.end(), begin);
        }
    }

    /// For each i the least of f(k) + (i - k)²: the lower envelope of parabolas.
    static std::vector<double> nearestSquares(const std::vector<double>& f) {
        std::vector<std::size_t> parabolas;
        std::vector<double> starts;  // from where on each is the lowest
        const auto height = [&f](std::size_t k) {
            return f[k] + static_cast<double>(k) * static_cast<double>(k);
        };
        for (std::size_t k = 0; k < f.size(); ++k) {
            double start = -std::numeric_limits<double>::infinity();
            while (!parabolas.empty()) {
                const std::size_t last = parabolas.back();
                start = (height(k) - height(last)) / (2 * static_cast<double>(k - last));
                if (start > starts.back()) break;
                parabolas.pop_back();
                starts.pop_back();
                start = -std::numeric_limits<double>::infinity();
            }
            parabolas.push_back(k);
            starts.push_back(start);
        }
        std::vector<double> least(f.size());
        std::size_t at = 0;
        for (std::size_t i = 0; i < f.size(); ++i) {
            const double x = static_cast<double>(i);
            while (at + 1 < starts.size() && starts[at + 1] <= x) ++at;
            const double away = x - static_cast<double>(parabolas[at]);
            least[i] = f[parabolas[at]] + away * away;
        }
        return least;
    }

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    double distance(int column, int row) const { return distances_[index(column, row)]; }

    static constexpr double kFar = 1e12;  // cells squared

    int columns_ = 0, rows_ = 0;
    double cell_ = 0;
    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();  // lower left corner
    std::vector<double> distances_;
};

}  // namespace avoid

#endif  // AVOID_GRID_MAP_H
