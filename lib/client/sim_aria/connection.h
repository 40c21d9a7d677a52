// SPDX-License-Identifier: GPL-3.0-or-later
// A connection finds simrun and adopts its clock; the dialogue of a robot is opened by ArRobot.
// openSimple() and open() wait up to six seconds for each of a few answers.
#ifndef SIM_ARIA_CONNECTION_H
#define SIM_ARIA_CONNECTION_H

#include <atomic>
#include <cstdlib>
#include <memory>
#include <string>

#include <sim_aria/clock.h>

namespace sim_aria {

/// Reads the environment variable that names the server, HOST:PORT; empty if unset.
inline std::string serverName() {
    const char* const name = std::getenv("ISPACE_SIMRUN");
    return name ? name : "";
}

}  // namespace sim_aria

/// A connection to the robot. All lead to simrun: at ISPACE_SIMRUN (HOST:PORT), by default
/// 127.0.0.1:7001; TCP uses its host and port unless the variable is set. ArRobot chooses the
/// robot.
class ArDeviceConnection {
  public:
    enum Status {
        STATUS_NEVER_OPENED = 1,
        STATUS_OPEN,
        STATUS_OPEN_FAILED,
        STATUS_CLOSED_NORMALLY,
        STATUS_CLOSED_ERROR
    };

    ArDeviceConnection() {}
    virtual ~ArDeviceConnection() {}
    ArDeviceConnection(const ArDeviceConnection&) = delete;
    ArDeviceConnection& operator=(const ArDeviceConnection&) = delete;

    virtual bool openSimple() = 0;
    virtual bool close() {
        *myStatus = STATUS_CLOSED_NORMALLY;
        return true;
    }
    /// Raw bytes are not supported: ArRobot sends requests.
    virtual int read(const char*, unsigned int, unsigned int = 0) { return -1; }
    virtual int write(const char*, unsigned int) { return -1; }
    virtual int getStatus() { return *myStatus; }
    virtual const char* getOpenMessage(int code) = 0;
    const char* getStatusMessage(int status) const {
        switch (status) {
            case STATUS_NEVER_OPENED:
                return "Never opened";
            case STATUS_OPEN:
                return "Open";
            case STATUS_OPEN_FAILED:
                return "Open failed";
            case STATUS_CLOSED_NORMALLY:
                return "Closed";
            case STATUS_CLOSED_ERROR:
                return "Closed due to error";
            default:
                return "Unknown";
        }
    }
    /// Address of simrun, once open.
    const std::string& simulator() const { return myServer; }
    /// The status for a robot that may outlive the connection.
    std::shared_ptr<std::atomic<int>> sharedStatus() const { return myStatus; }

  protected:
    /// Checks that simrun answers there, and adopts its time.
    /// \throws ispace::client::Error
    void reach(const std::string& server) {
        *myStatus = STATUS_OPEN_FAILED;
        ispace::client::Options options;
        options.timeout = 6;
        sim_aria::Clock::get().follow(ispace::client::Address(server), options);
        myServer = server;
        *myStatus = STATUS_OPEN;
    }

  private:
    std::shared_ptr<std::atomic<int>> myStatus =
        std::make_shared<std::atomic<int>>(static_cast<int>(STATUS_NEVER_OPENED));
    std::string myServer;
};

/// The serial line of a robot.
class ArSerialConnection : public ArDeviceConnection {
  public:
    enum Open {
        OPEN_COULD_NOT_OPEN_PORT = 1,
        OPEN_COULD_NOT_SET_UP_PORT,
        OPEN_INVALID_BAUD_RATE,
        OPEN_COULD_NOT_SET_BAUD,
        OPEN_ALREADY_OPEN
    };

    explicit ArSerialConnection(bool /*is422*/ = false) {}
    /// \return 0, or one of Open
    int open(const char* port = nullptr) {
        if (port) setPort(port);
        if (getStatus() == STATUS_OPEN) return OPEN_ALREADY_OPEN;
        try {
            const std::string server = sim_aria::serverName();
            reach(server.empty() ? "127.0.0.1:7001" : server);
        } catch (const ispace::client::Error&) {
            return OPEN_COULD_NOT_OPEN_PORT;
        }
        return 0;
    }
    bool openSimple() override { return getStatus() == STATUS_OPEN || open() == 0; }
    const char* getOpenMessage(int code) override {
        switch (code) {
            case 0:
                return "Open";
            case OPEN_COULD_NOT_OPEN_PORT:
                return "Could not open serial port (is simrun running?)";
            case OPEN_ALREADY_OPEN:
                return "Port already open";
            default:
                return "Could not set up serial port";
        }
    }
    void setPort(const char* port = nullptr) { myPort = port ? port : "/dev/ttyS0"; }
    const char* getPort() const { return myPort.c_str(); }
    const char* getPortName() const { return myPort.c_str(); }
    bool setBaud(int baud) {
        myBaud = baud;
        return true;
    }
    int getBaud() const { return myBaud; }
    /// Lines of a modem: there is none.
    bool getDCD() const { return false; }
    bool getCTS() const { return false; }
    bool getDSR() const { return false; }
    bool getRing() const { return false; }

  private:
    std::string myPort = "/dev/ttyS0";
    int myBaud = 9600;
};

/// A robot, or its simulator, on a network.
class ArTcpConnection : public ArDeviceConnection {
  public:
    enum Open { OPEN_NET_FAIL = 1, OPEN_BAD_HOST, OPEN_NO_ROUTE, OPEN_CON_REFUSED };

    ArTcpConnection() {}
    /// \return 0, or one of Open
    int open(const char* host = nullptr, int port = 8101) {
        setPort(host, port);
        if (getStatus() == STATUS_OPEN) return 0;
        try {
            const std::string server = sim_aria::serverName();
            reach(server.empty() ? myHost + ":" + std::to_string(myPort) : server);
        } catch (const ispace::client::ConnectionError&) {
            return OPEN_CON_REFUSED;
        } catch (const ispace::client::Timeout&) {
            return OPEN_NO_ROUTE;
        } catch (const ispace::client::Error&) {
            return OPEN_NET_FAIL;
        }
        return 0;
    }
    bool openSimple() override {
        return getStatus() == STATUS_OPEN || open(myHost.c_str(), myPort) == 0;
    }
    const char* getOpenMessage(int code) override {
        switch (code) {
            case 0:
                return "Open";
            case OPEN_BAD_HOST:
                return "Could not find the host";
            case OPEN_NO_ROUTE:
                return "No route to the host";
            case OPEN_CON_REFUSED:
                return "Connection refused (is simrun running?)";
            default:
                return "Network failure";
        }
    }
    void setPort(const char* host = nullptr, int port = 8101) {
        myHost = host ? host : "localhost";
        myPort = port;
    }
    const char* getHost() const { return myHost.c_str(); }
    int getPort() const { return myPort; }

  private:
    std::string myHost = "localhost";
    int myPort = 8101;
};

#endif  // SIM_ARIA_CONNECTION_H
