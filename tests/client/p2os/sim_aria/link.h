// SPDX-License-Identifier: GPL-3.0-or-later
// Instead of the header of this name: the robot of a program for ARIA behind a port of --p2os,
// whose address is in the variable ISPACE_P2OS. Time is that of simrun's own protocol, whose clock
// `step` the program drives.
#ifndef SIM_ARIA_LINK_H
#define SIM_ARIA_LINK_H

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <ispace_client/reading.h>
#include <ispace_client/world.h>
#include <sim_aria/math.h>
#include <sim_aria/util.h>

namespace sim_aria {

/// Contents of a status packet, as in the header itself.
struct Packet {
    double time = 0;
    ArPose pose;
    double vel = 0, rot_vel = 0;
    bool stalled = false;
    std::vector<int> sonar;
    int bumpers = 0;
};

/// A Pioneer 3-DX without lasers, by packets of P2OS.
class Link {
  public:
    Link(const std::string& /*server*/, double /*timeout*/) {
        const std::string address = std::getenv("ISPACE_P2OS");
        sockaddr_in to = {};
        to.sin_family = AF_INET;
        to.sin_port =
            htons(static_cast<std::uint16_t>(std::atoi(address.c_str() + address.rfind(':') + 1)));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socket_ = socket(AF_INET, SOCK_STREAM, 0);
        if (connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
            throw ispace::client::Error(address + " refuses the connection");
        for (int sync = 0; sync < 3; ++sync) {
            send(sync, {});
            while (next()[0] != sync) {
            }
        }
        com(kOpen, 1);
        com(kEnable, 1);
        read(true);
    }
    ~Link() { ::close(socket_); }
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

    std::string id() const { return "r1"; }
    std::string model() const { return "pioneer-3dx"; }
    double radius() const { return 250; }
    double maxVel() const { return 1600; }
    double maxRotVel() const { return 300; }
    double accel() const { return 300; }
    double rotAccel() const { return 100; }
    int frontBumpers() const { return 0; }
    int rearBumpers() const { return 0; }
    std::vector<ArPose> sonars() const {
        std::vector<ArPose> ring;
        for (const int(&at)[3] : kRing) ring.push_back(ArPose(at[0], at[1], at[2]));
        return ring;
    }
    std::vector<std::string> lasers() { return {}; }
    ispace::client::Scan scan(const std::string&) { return {}; }
    ispace::client::Fields laser(const std::string&) { return {}; }
    ArPose mount(const std::string&) { return ArPose(); }

    /// The newest packet: the answer to CONFIG comes after all that were sent before.
    Packet read(bool /*sonar*/) {
        com(kConfig, 1);
        for (std::string packet = next(); byte(packet, 0) != kConfigured; packet = next())
            if (byte(packet, 0) == kStatus)
                adopt(packet);
            else if (byte(packet, 0) == kSim)
                true_pose_.setPose(number(packet, 13), number(packet, 17), number(packet, 25));
        return newest_;
    }
    /// As the packet says that SIM_STAT asks for.
    ArPose truePose() {
        com(kSimStat, 1);
        return true_pose_;
    }
    void place(const ArPose& to) {
        std::string data(1, 0);
        for (const double value : {to.getX(), to.getY(), to.getTh()})
            for (int i = 0; i < 4; ++i)
                data += static_cast<char>((std::lround(value) >> (8 * i)) & 0xFF);
        send(kSimSetPose, data);
        read(true);
        const ArPose at = truePose();
        if (at.findDistanceTo(to) > 1) throw ispace::client::Error("the robot does not fit there");
    }
    void vel(double value) { com(kVel, std::lround(value)); }
    void rotVel(double value) { com(kRvel, std::lround(value)); }
    void stop() { com(kStop, 0); }
    void close() { com(kClose, 1); }
    /// Sends a command with a number, and waits until it was obeyed.
    void com(int id, long value) {
        const long size = std::labs(value);
        send(id, {static_cast<char>(value < 0 ? 0x1B : 0x3B), static_cast<char>(size & 0xFF),
                  static_cast<char>(size >> 8)});
        if (id == kConfig || id == kClose) return;
        read(true);
    }

  private:
    enum Id {
        kOpen = 1,
        kClose = 2,
        kEnable = 4,
        kVel = 11,
        kConfig = 18,
        kRvel = 21,
        kStop = 29,
        kSimSetPose = 224,
        kSimStat = 237
    };
    static constexpr unsigned kConfigured = 0x20, kStatus = 0x32, kSim = 0x62;
    static constexpr int kRing[16][3] = {
        {69, 136, 90},     {114, 119, 50},     {148, 78, 30},     {166, 27, 10},
        {166, -27, -10},   {148, -78, -30},    {114, -119, -50},  {69, -136, -90},
        {-157, -136, -90}, {-203, -119, -130}, {-237, -78, -150}, {-255, -27, -170},
        {-255, 27, 170},   {-237, 78, 150},    {-203, 119, 130},  {-157, 136, 90}};

    static unsigned byte(const std::string& text, std::size_t at) {
        return static_cast<unsigned char>(text.at(at));
    }
    static int word(const std::string& text, std::size_t at) {
        return static_cast<std::int16_t>(byte(text, at) | byte(text, at + 1) << 8);
    }
    static std::int32_t number(const std::string& text, std::size_t at) {
        return static_cast<std::int32_t>(byte(text, at) | byte(text, at + 1) << 8 |
                                         byte(text, at + 2) << 16 | byte(text, at + 3) << 24);
    }
    static unsigned checksum(const std::string& body) {
        unsigned sum = 0;
        for (std::size_t i = 0; i + 1 < body.size(); i += 2)
            sum += byte(body, i) << 8 | byte(body, i + 1);
        return (body.size() % 2 == 1 ? sum ^ byte(body, body.size() - 1) : sum) & 0xFFFF;
    }

    void send(int id, const std::string& data) {
        const std::string body = static_cast<char>(id) + data;
        const unsigned sum = checksum(body);
        const std::string bytes = "\xFA\xFB" + std::string(1, static_cast<char>(body.size() + 2)) +
                                  body + static_cast<char>(sum >> 8) +
                                  static_cast<char>(sum & 0xFF);
        if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0)
            throw ispace::client::Error("the robot is gone");
    }
    /// The next packet's id and data.
    std::string next() {
        const std::string head = take(3);
        if (byte(head, 0) != 0xFA || byte(head, 1) != 0xFB)
            throw ispace::client::Error("no packet begins here");
        const std::string rest = take(byte(head, 2));
        const std::string body = rest.substr(0, rest.size() - 2);
        if (checksum(body) != (byte(rest, body.size()) << 8 | byte(rest, body.size() + 1)))
            throw ispace::client::Error("a packet with a wrong checksum");
        return body;
    }
    std::string take(std::size_t count) {
        std::string bytes(count, 0);
        for (std::size_t have = 0; have < count;) {
            const ssize_t more = recv(socket_, &bytes[have], count - have, 0);
            if (more <= 0) throw ispace::client::Error("the robot is gone");
            have += static_cast<std::size_t>(more);
        }
        return bytes;
    }
    void adopt(const std::string& packet) {
        newest_.time += 0.1;
        newest_.pose.setPose(word(packet, 1), word(packet, 3), word(packet, 5) * 360.0 / 4096);
        newest_.vel = (word(packet, 7) + word(packet, 9)) / 2.0;
        newest_.stalled = (byte(packet, 12) & 1) != 0;
        newest_.bumpers = newest_.stalled ? word(packet, 12) & 0xFEFE : 0;
        const std::size_t count = byte(packet, 19);
        newest_.sonar.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            newest_.sonar.at(byte(packet, 20 + 3 * i)) = word(packet, 21 + 3 * i);
        newest_.rot_vel = word(packet, 20 + 3 * count + 8) / 10.0;
    }

    int socket_ = -1;
    Packet newest_;
    ArPose true_pose_;
};

constexpr int Link::kRing[16][3];

}  // namespace sim_aria

#endif  // SIM_ARIA_LINK_H
