// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/mqtt.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "extensions/mqtt/mqtt_client.h"

namespace ispace::mqtt {

/// The prefix of a run on its broker: asks whether another run serves it, and finds what an earlier
/// one left there.
class MqttSurvey {
  public:
    /// Asks the broker for its retained messages, and a run that is online under this prefix for a
    /// sign of life. Takes as long as the broker needs for an answer, and a second if a run that
    /// seems to be online has died; at most that long.
    /// \throws FormatError if another run answers
    MqttSurvey(MqttClient& client, const std::string& prefix);

    /// Returns the topics of states and descriptions of earlier runs under this prefix.
    [[nodiscard]] const std::set<std::string>& leftovers() const { return leftovers_; }
    /// Answers other runs that ask; true if the message is of this dialogue.
    bool answer(const MqttMessage& message);

  private:
    void collect(const MqttMessage& message);

    MqttClient* client_;
    std::string prefix_, topic_, id_;
    std::set<std::string> leftovers_;
};

}  // namespace ispace::mqtt
