// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/ros/module/dds_participant.h"

namespace ispace::testing {

/// Topics without a network: peers are played by the test.
class FakeParticipant final : public ros::DdsParticipant {
  public:
    int addWriter(const ros::DdsTopic& topic) override { return add(topic); }
    int addReader(const ros::DdsTopic& topic) override { return add(topic); }
    void remove(int end) override { ends.erase(end); }
    [[nodiscard]] ros::DdsGuid guid() const override { return {1}; }
    [[nodiscard]] ros::DdsGuid guid(int end) const override {
        return {2, static_cast<std::uint8_t>(end)};
    }
    bool changed() override { return std::exchange(is_changed, false); }
    [[nodiscard]] bool isRead(int writer) const override { return ends.at(writer).is_read; }
    void write(int writer, std::string_view message) override {
        ends.at(writer).sent.emplace_back(message);
    }
    void answer(int writer, const ros::DdsRequest& request, std::string_view message) override {
        ends.at(writer).answers.emplace_back(request, message);
    }
    std::vector<ros::DdsMessage> take(int reader) override {
        return std::exchange(ends.at(reader).arrived, {});
    }

    struct Known {
        ros::DdsTopic topic;
        bool is_read = false;
        std::vector<std::string> sent;
        std::vector<std::pair<ros::DdsRequest, std::string>> answers;
        std::vector<ros::DdsMessage> arrived;
    };
    Known& end(const std::string& name, const std::string& type = "") {
        for (auto& [number, one] : ends)
            if (one.topic.name == name && (type.empty() || one.topic.type == type)) return one;
        throw std::out_of_range(name);
    }
    [[nodiscard]] bool has(const std::string& name) const {
        return std::any_of(ends.begin(), ends.end(),
                           [&](const auto& one) { return one.second.topic.name == name; });
    }

    std::map<int, Known> ends;
    bool is_changed = false;

  private:
    int add(const ros::DdsTopic& topic) {
        ends[++last_].topic = topic;
        return last_;
    }
    int last_ = 0;
};

}  // namespace ispace::testing
