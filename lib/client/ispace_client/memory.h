// SPDX-License-Identifier: GPL-3.0-or-later
// Texts at places of a room, and the tags that touch them. Metres and seconds.
#ifndef ISPACE_CLIENT_MEMORY_H
#define ISPACE_CLIENT_MEMORY_H

#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A tag comes into a volume ("touch"), stays there ("dwell"), or has left it ("leave").
struct Touch {
    std::string kind;
    double time = 0;  ///< seconds
    std::string volume, tag;
    double lasted = 0;  ///< since the touch, seconds
    std::string content;
};

/// Contents kept at places of a room (role MEMORY): tells what tags touch, by their measured
/// positions.
///
///     Memory memory("127.0.0.1:7001");
///     memory.store("news", 1, 0.5, 1.6, "today's headline", 0.2);
///     for (Touch touch; memory.nextTouch(touch, 60);)
///         if (touch.kind == "touch") show(touch.content);
class Memory {
  public:
    /// \param tags those that it hears of, a pattern of ids
    explicit Memory(const Address& address, const std::string& tags = "*",
                    const Options& options = Options())
        : connection_(address, options) {
        tags_ = split(connection_.ask("MEMORY " + tags).fields.text("tags", ""), ',');
    }
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    /// Returns the ids of the tags that it hears of.
    const std::vector<std::string>& tags() const { return tags_; }

    /// Keeps a content in a ball about a place, metres; replaces that of the same id.
    void store(const std::string& id, double x, double y, double z, const std::string& content,
               double radius) {
        connection_.ask("STORE " + id + " " + textOf(x) + "," + textOf(y) + "," + textOf(z) +
                        " radius=" + textOf(radius) + " " + content);
    }
    void forget(const std::string& id) { connection_.ask("FORGET " + id); }
    /// Returns the volumes that contain a point, the nearest centre first.
    std::vector<std::string> at(double x, double y, double z) {
        return find(textOf(x) + "," + textOf(y) + "," + textOf(z));
    }
    /// Returns the volumes with this text in their content, in capitals or not.
    std::vector<std::string> find(const std::string& text) {
        return split(connection_.ask("FIND " + text).fields.text("ids", ""), ',');
    }
    /// Returns the content of a volume.
    std::string recall(const std::string& id) {
        return connection_.ask("RECALL " + id).fields.text("text", "");
    }

    /// Waits for the next touch, stay or leave. \returns false after `timeout` seconds of wall time
    bool nextTouch(Touch& touch, double timeout) {
        Message message;
        while (connection_.nextEvent(message, timeout)) {
            const std::string kind = message.word(1);
            if (kind != "touch" && kind != "dwell" && kind != "leave") continue;
            const Fields& fields = message.fields;
            touch.kind = kind;
            touch.time = fields.number("t");
            touch.volume = fields.text("id");
            touch.tag = fields.text("by");
            touch.lasted = fields.number("for");
            touch.content = fields.text("text");
            return true;
        }
        return false;
    }

  private:
    Connection connection_;
    std::vector<std::string> tags_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_MEMORY_H
