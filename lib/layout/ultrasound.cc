// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/ultrasound.h"

#include "layout/limits.h"

namespace ispace {

Receiver withFigures(Receiver base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) base.fov = record.angle("fov");
    if (record.has("rate")) base.rate = record.number("rate");
    applyNoise(record, base.noise, findings);
    findings.throwIfAny();
    return base;
}

Receiver receiverOf(const Record& record, const DeviceCatalogue& devices) {
    return modelled<Receiver>(record, devices);
}

Tag withFigures(Tag base, const Record& record) {
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("fov")) base.fov = record.angle("fov");
    if (record.has("locate")) base.is_simple = record.text("locate") == "simple";
    if (record.has("sigma")) base.simple_sigma = record.number("sigma");
    return base;
}

Tag tagOf(const Record& record, const DeviceCatalogue& devices) {
    return modelled<Tag>(record, devices);
}

}  // namespace ispace
