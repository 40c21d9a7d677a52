// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/texts.h"

#include <cmath>

#include "base/number.h"

namespace ispace {

std::string nameOf(const Element& element) { return element.record.keyword() + ' ' + element.id; }

std::string lengthText(double length) {
    int decimals = 3;
    while (decimals < 12 && length * std::pow(10, decimals) < 10) ++decimals;
    std::string text = formatFixed(length, decimals);
    while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
    return text;
}

}  // namespace ispace
