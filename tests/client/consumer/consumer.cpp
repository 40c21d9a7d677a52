// SPDX-License-Identifier: GPL-3.0-or-later
#include <ispace_client.h>

#include <iostream>

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        ispace::client::World world(argv[1]);
        ispace::client::Robot robot(argv[1], "r1");
        const ispace::client::Motion motion = robot.forward(0.5);
        world.step(2000);
        std::cout << (robot.wait(motion, 10).done ? "there" : "not there") << '\n';
        world.shutdown();
    } catch (const ispace::client::Error& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
