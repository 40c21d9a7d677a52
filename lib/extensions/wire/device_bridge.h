// SPDX-License-Identifier: GPL-3.0-or-later
// The ports of --p2os, --scip and their kin: connects the protocols of devices to a run.
#pragma once

#include <list>
#include <string>

#include "extensions/wire/device_port.h"
#include "extensions/wire/picture_files.h"
#include "server/bridge.h"

namespace ispace::wire {

/// Serves robots and sensors of a run through the protocols of real devices, each at a port of its
/// own. Pictures are captured once for all ports.
class DeviceBridge final : public Bridge {
  public:
    explicit DeviceBridge(const BridgeHost& host) : host_(host) {}

    /// Starts listening. Call before Server::run(). \param id across the run
    /// \returns "127.0.0.1:10940"
    /// \throws UsageError if the world has no such device, std::system_error naming the endpoint
    std::string open(const WireProtocol& protocol, const std::string& id, const Endpoint& endpoint);

    void stepped() override;
    void serve(bool has_made) override;
    [[nodiscard]] bool waitsToChange() const override;
    void end() override;
    [[nodiscard]] bool busy() override;
    void closeAll() override;

  private:
    BridgeHost host_;
    PictureFiles pictures_;
    std::list<DeviceHost> hosts_;
    std::list<DevicePort> ports_;
};

}  // namespace ispace::wire
