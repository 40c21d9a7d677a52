// SPDX-License-Identifier: GPL-3.0-or-later
// Programs that run as nodes of a sensor network, with a clock each, over a line that delays and
// loses messages.
#ifndef ISPACE_CLIENT_NODE_H
#define ISPACE_CLIENT_NODE_H

#include <limits>
#include <string>
#include <vector>

#include <ispace_client/connection.h>
#include <ispace_client/reading.h>

namespace ispace {
namespace client {

/// A message that a node has received.
struct NodeMessage {
    double time = 0;   ///< of arrival, by the receiver's clock, seconds
    std::string from;  ///< node
    long number = 0;   ///< of the sender's messages, from 1; gaps show lost ones
    std::string text;
};

/// A node of a sensor network (role NODE): reads its sensors, talks to other nodes over a line with
/// delays and losses, and has its own clock, by which all times are. One client has the role of a
/// node. In lockstep runs of programs that do the same repeat exactly, whatever their speed: the
/// world does not pass the time for which a node waits.
///
///     Node node("127.0.0.1:7001", "n1");
///     for (double t = 0.1;; t += 0.1) {
///         node.await(t);
///         const Scan scan = node.scan<Scan>("l1");
///         node.send("person 1.25 0.40");
///     }
class Node {
  public:
    Node(const Address& address, const std::string& id, const Options& options = Options())
        : connection_(address, options), id_(id) {
        const Fields fields = connection_.ask("NODE " + id).fields;
        sensors_ = split(fields.text("sensors", ""), ',');
        lockstep_ = fields.text("lockstep", "0") == "1";
    }
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    const std::string& id() const { return id_; }
    const std::vector<std::string>& sensors() const { return sensors_; }
    /// True if the world waits for this program, see await().
    bool lockstep() const { return lockstep_; }
    double time() { return connection_.ask("TIME").fields.number("t"); }

    /// Waits until the clock shows this; returns the time then. Of a node in lockstep, the world
    /// waits there for the next call. \throws Refused if the run ends before
    double await(double time) {
        return connection_.ask("AWAIT " + textOf(time), std::numeric_limits<double>::infinity())
            .fields.number("t");
    }

    /// Returns the newest reading of a sensor of this node.
    template <class T>
    T scan(const std::string& sensor) {
        return T::from(connection_.ask("SCAN " + sensor));
    }
    /// Starts a stream of a sensor, but for cameras and rangers.
    void stream(const std::string& sensor, int every = 1) {
        connection_.ask("STREAM " + sensor + " every=" + std::to_string(every));
    }
    /// Returns the next reading of any stream, see Reading::sensor. \throws Timeout
    template <class T>
    T next(double timeout) {
        Message message;
        if (!connection_.nextScan(message, timeout)) throw Timeout("no reading of node " + id_);
        return T::from(message);
    }

    /// Sends a line of text to the nodes that hear this one; returns its number.
    long send(const std::string& text) {
        return connection_.ask("SEND " + text).fields.integer("n");
    }
    /// Receives from now on what these nodes send, or all others.
    void hear(const std::vector<std::string>& nodes = std::vector<std::string>()) {
        std::string request = "HEAR";
        for (const std::string& node : nodes) request += " " + node;
        connection_.ask(request);
    }
    /// Takes the next message that has arrived; waits up to so many seconds of wall time.
    /// \return false without one
    bool receive(NodeMessage& message, double timeout = 0) {
        Message line;
        while (connection_.nextEvent(line, timeout)) {
            if (line.word(1) != "message") continue;
            message.time = line.fields.number("t");
            message.from = line.fields.text("from");
            message.number = line.fields.integer("n");
            message.text = line.fields.text("text");
            return true;
        }
        return false;
    }

    /// Tells where a person or robot is, for the page, the record and topics. \param name of the
    /// track \param kind "person", "robot" or "" \param time of the position, by this clock
    void track(const std::string& name, double x, double y, double time,
               const std::string& kind = "") {
        connection_.ask("TRACK " + name + " " + textOf(x) + "," + textOf(y) + " t=" + textOf(time) +
                        (kind.empty() ? "" : " kind=" + kind));
    }

    /// For requests without a function in this class.
    Connection& connection() { return connection_; }

  private:
    Connection connection_;
    std::string id_;
    std::vector<std::string> sensors_;
    bool lockstep_ = false;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_NODE_H
