// SPDX-License-Identifier: GPL-3.0-or-later
// Half-planes of velocities, and the velocity in all of them that is nearest to a wanted one: van
// den Berg, Guy, Lin, Manocha, Reciprocal n-Body Collision Avoidance, 2011.
#ifndef SOCIAL_ORCA_H
#define SOCIAL_ORCA_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "plane.h"

namespace social {

/// Velocities to the left of a directed line, and on it, are permitted.
struct OrcaLine {
    Vec point, direction;
};

/// Returns the velocities by which one does its share of the work of avoiding another.
/// \param offset from the one to the other \param reach sum of both radii \param horizon seconds
/// without a collision \param step seconds in which those that overlap part
/// \param share of the work, a half if the other does the same
inline OrcaLine orcaLine(Vec offset, Vec velocity, Vec other, double reach, double horizon,
                         double step, double share) {
    const Vec relative = velocity - other;
    const double apart = dot(offset, offset), square = reach * reach;
    OrcaLine line;
    Vec change;
    if (apart > square) {
        const Vec w = relative - (1 / horizon) * offset;
        const double size = dot(w, w), along = dot(w, offset);
        if (along < 0 && along * along > square * size) {  // the cut-off circle is nearest
            const double length_w = std::sqrt(size);
            const Vec unit = (1 / length_w) * w;
            line.direction = Vec(unit.y, -unit.x);
            change = (reach / horizon - length_w) * unit;
        } else {  // a leg of the cone
            const double leg = std::sqrt(apart - square);
            if (cross(offset, w) > 0)
                line.direction = (1 / apart) * Vec(offset.x * leg - offset.y * reach,
                                                   offset.x * reach + offset.y * leg);
            else
                line.direction = (-1 / apart) * Vec(offset.x * leg + offset.y * reach,
                                                    -offset.x * reach + offset.y * leg);
            change = dot(relative, line.direction) * line.direction - relative;
        }
    } else {
        const Vec w = relative - (1 / step) * offset;
        const double length_w = std::max(length(w), 1e-9);
        const Vec unit = (1 / length_w) * w;
        line.direction = Vec(unit.y, -unit.x);
        change = (reach / step - length_w) * unit;
    }
    line.point = velocity + share * change;
    return line;
}

/// Finds the best velocity on a line within the lines before it and a disc. Returns false if there
/// is none. \param by_direction `wanted` is a unit vector, along which it is to be farthest
inline bool bestOnLine(const std::vector<OrcaLine>& lines, std::size_t at, double most, Vec wanted,
                       bool by_direction, Vec& result) {
    const OrcaLine& line = lines[at];
    const double along = dot(line.point, line.direction);
    const double inside = along * along + most * most - dot(line.point, line.point);
    if (inside < 0) return false;
    const double root = std::sqrt(inside);
    double low = -along - root, high = -along + root;
    for (std::size_t i = 0; i < at; ++i) {
        const double denominator = cross(line.direction, lines[i].direction);
        const double numerator = cross(lines[i].direction, line.point - lines[i].point);
        if (std::abs(denominator) <= 1e-9) {
            if (numerator < 0) return false;
            continue;
        }
        const double t = numerator / denominator;
        if (denominator >= 0)
            high = std::min(high, t);
        else
            low = std::max(low, t);
        if (low > high) return false;
    }
    double t = 0;
    if (by_direction)
        t = dot(wanted, line.direction) > 0 ? high : low;
    else
        t = std::max(low, std::min(high, dot(line.direction, wanted - line.point)));
    result = line.point + t * line.direction;
    return true;
}

/// Returns the number of lines that the result obeys, which are all if there is such a velocity.
inline std::size_t bestVelocity(const std::vector<OrcaLine>& lines, double most, Vec wanted,
                                bool by_direction, Vec& result) {
    if (by_direction)
        result = most * wanted;
    else if (dot(wanted, wanted) > most * most)
        result = (most / length(wanted)) * wanted;
    else
        result = wanted;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (cross(lines[i].direction, lines[i].point - result) <= 0) continue;
        const Vec before = result;
        if (!bestOnLine(lines, i, most, wanted, by_direction, result)) {
            result = before;
            return i;
        }
    }
    return lines.size();
}

/// Returns the velocity nearest to a wanted one that obeys all lines; if there is none, that which
/// breaks those after the first `fixed` ones least.
inline Vec orcaVelocity(const std::vector<OrcaLine>& lines, std::size_t fixed, double most,
                        Vec wanted) {
    Vec result;
    const std::size_t obeyed = bestVelocity(lines, most, wanted, false, result);
    double distance = 0;
    for (std::size_t i = obeyed; i < lines.size(); ++i) {
        if (cross(lines[i].direction, lines[i].point - result) <= distance) continue;
        const std::size_t kept = std::min(fixed, i);
        std::vector<OrcaLine> projected(lines.begin(),
                                        lines.begin() + static_cast<std::ptrdiff_t>(kept));
        for (std::size_t j = kept; j < i; ++j) {
            OrcaLine line;
            const double determinant = cross(lines[i].direction, lines[j].direction);
            if (std::abs(determinant) <= 1e-9) {
                if (dot(lines[i].direction, lines[j].direction) > 0) continue;
                line.point = 0.5 * (lines[i].point + lines[j].point);
            } else {
                const double t =
                    cross(lines[j].direction, lines[i].point - lines[j].point) / determinant;
                line.point = lines[i].point + t * lines[i].direction;
            }
            const Vec turned = lines[j].direction - lines[i].direction;
            line.direction = (1 / length(turned)) * turned;
            projected.push_back(line);
        }
        const Vec before = result;
        const Vec away(-lines[i].direction.y, lines[i].direction.x);
        if (bestVelocity(projected, most, away, true, result) < projected.size()) result = before;
        distance = cross(lines[i].direction, lines[i].point - result);
    }
    return result;
}

}  // namespace social

#endif  // SOCIAL_ORCA_H
