// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/guesses.h"

#include <algorithm>
#include <array>

namespace ispace {

namespace {

/// Options as GDAL, osmium, Nav2, ROS 2, Gazebo, JVSG, Axis' tools and others name them. Each row
/// is for some tools; an earlier row wins. A test tries them, and looks up the options in the
/// advice.
struct Guess {
    std::string_view tools;    // "": all
    std::string_view options;  // separated by blanks
    std::string_view advice;
};

constexpr auto kGuesses = std::to_array<Guess>({
    // Reports and material.
    {"coverage arrange", "--bom --materials --parts --parts-list --bill-of-materials --quote",
     "--material FILE.csv, and --report FILE.html, have devices, mounts and cables with prices"},
    {"coverage arrange", "--customer --for", "--client TEXT is on the cover of --report"},
    {"coverage arrange", "--company --installer --by", "--author TEXT is on the cover of --report"},
    {"coverage arrange", "--project-name --name", "--project TEXT is on the cover of --report"},
    {"coverage arrange", "--price --prices-file --price-list --pricelist --costs",
     "--prices FILE.csv has lines ITEM,PRICE"},
    {"coverage arrange", "--image --icon", "--logo FILE.png is on the cover of --report"},
    {"coverage arrange", "--page-size --papersize", "--paper a4|letter"},
    {"coverage arrange envc simrun", "--html --pdf --page", "--report FILE.html or FILE.pdf"},
    // Cameras.
    {"coverage arrange",
     "--ppm --ppf --dori --pixel-density --pixels-per-metre --pixels-per-meter --quality",
     "--density N|NAME is the number of pixels a metre, or a class such as recognise or identify"},
    {"coverage", "--blind-spots --blindspots --gaps --uncovered --holes",
     "-o map.png draws floor that no sensor sees, and --suggest tells changes that help"},
    {"coverage", "--heatmap --heat", "-o map.png --color redundancy"},
    {"arrange", "--heatmap", "--heat FILE"},
    {"coverage arrange", "--roi --region --area --mask --bbox --extent --clip",
     "--zone ZONE is the id of a zone, rect:X,Y,X,Y or poly:X,Y;X,Y;..."},
    {"arrange", "--exclude --no-go --forbidden --keepout --obstacles",
     "--keep-out ZONE keeps sensors out, --zone leaves out floor"},
    {"coverage", "--exclude --no-go --forbidden --mask-zone", "--privacy ZONE"},
    // Sensors and their number.
    {"arrange",
     "--camera --cameras --device --lidar --laser --num --number --count --num-sensors -n",
     "--sensor MODEL:COUNT, as in --sensor dome-2.8-1080p:4; scan --list-models lists the devices"},
    {"arrange", "--fov --range --angle --beams --focal-length",
     "a key of the sensor, as in --sensor laser,range=4,fov=270:3"},
    {"arrange", "--mount-height --mounting-height --sensor-height --height", "--z H"},
    {"coverage arrange envc simrun",
     "--list-devices --list-cameras --list-sensors --devices --catalogue",
     "scan --list-models lists the devices"},
    {"scan", "--list-devices --list-cameras --list-sensors --devices --catalogue", "--list-models"},
    {"arrange", "--min-coverage --goal --coverage --percent",
     "--target SHARE finds the fewest sensors"},
    {"coverage", "--min-coverage --threshold --target --fail-under --assert",
     "--require SHARE exits with 3 if less is covered"},
    {"arrange", "--overlap --k-coverage --min-sensors", "--redundancy K"},
    {"arrange", "--method --algorithm --solver --optimizer", "--optimize greedy|swap|exact"},
    {"arrange coverage", "--timeout --max-time --max-seconds", "--time-limit TIME"},
    {"coverage arrange", "--resolution --res --cell-size --grid-size --tr", "--cell M"},
    // Inputs and outputs.
    {"", "--floor --level --storeys --etage", "--storey ID"},
    {"simrun", "--map --world --env --scene --input",
     "operands have no option: simrun ENV [LAYOUT]"},
    {"envc", "--input --in --src", "operands have no option: envc INPUT..."},
    {"", "--map --world --env --scene --input --layout --in",
     "operands have no option: the room first, then the layout"},
    {"arrange", "--format --output-format --of --type", "the layout is a .3dm: -o FILE"},
    {"", "--format --output-format --of --type", "--to FORMAT, or the suffix of -o FILE"},
    {"simrun", "--log --log-dir --output-dir --save", "--record DIR"},
    {"", "--out --outfile --output-file --save --dst", "-o FILE"},
    {"", "--overwrite --force -y -f -O", "-o FILE replaces a file that is there"},
    {"", "--silent --no-warnings", "-q reports only errors"},
    {"", "--debug --trace-level --log-level", "-v prints more about the work"},
    {"", "--jobs --cores --nproc --num-threads --workers --parallel", "-j N"},
    {"", "--random-seed --rng", "--seed N"},
    // Rooms.
    {"envc", "--validate --lint --verify --test", "--check"},
    {"envc", "--inspect --describe --stats --summary --list", "--info"},
    {"envc", "--layer --layers --walls", "--wall-layer GLOB"},
    {"envc", "--scale --unit --dpi", "--units m|cm|mm|..., or --width-is M"},
    {"envc", "--convert --t --ot", "--to FORMAT, or the suffix of -o FILE"},
    {"envc", "--crop --room --select --extract", "--inside X,Y keeps the room of a point"},
    {"envc", "--rename --edit --update", "--set ID.KEY=VALUE"},
    // Readings.
    {"scan", "--pointcloud --point-cloud --pc", "--to pcd, or -o FILE.pcd"},
    {"scan", "--snapshot --image --photo --picture --screenshot", "--to png, or -o FILE.png"},
    {"scan", "--trajectory --pose", "--poses FILE"},
    {"scan", "--render --camera --viewpoint", "--view SPEC"},
    {"scan", "--sensor --sensors --id --topic --only", "--select GLOB"},
    {"scan", "--count --number -n --repeat", "--frames N"},
    // Runs.
    {"simrun", "--headless --no-gui --no-display",
     "no display is needed; --web ADDR:PORT shows it"},
    {"simrun", "--gui --rviz --viewer --show --ui --display", "--web ADDR:PORT"},
    {"simrun", "--rate --rtf --real-time-factor --speedup --speed-factor --realtime",
     "--clock real:20 is twenty times as fast as real time, --clock fast as fast as it can"},
    {"simrun", "--duration --time --sim-time --timeout --max-time --end", "--until TIME"},
    {"simrun", "--timestep --time-step --step-size --step", "--dt TIME"},
    {"simrun", "--bag --rosbag --record-bag", "--mcap FILE"},
    {"simrun", "--domain-id --ros-domain-id --domain --ros --ros-args --use-sim-time",
     "--ros2 N is a node in the domain N, with /clock"},
    {"simrun", "--goal --goto --waypoints --path --drive --initial-pose --commands",
     "--script FILE has lines such as `0 r1 GOTO 2,1.5`"},
    {"simrun", "--params --params-file --config",
     "the records of LAYOUT have the parameters of robots"},
    {"simrun", "--port --host --bind --address --server", "--listen ADDR:PORT"},
    {"simrun", "--video --film --movie --gif", "--replay DIR -o FILE.gif draws a film"},
    {"simrun", "--headless-rendering --sensors --only", "--no-record-readings leaves readings out"},
    {"simrun", "--assert --require --check",
     "--expect SENTENCE exits with 3 unless the run does this"},
    {"", "--config --params --params-file --options",
     "options stand on the command line, parameters of sensors in their records"},
    {"", "--version-info --about --license --licence", "-V"},
    {"", "--usage --man --manual -?", "-h"},
});

/// True if one of the words, separated by blanks, is this one.
bool hasWord(std::string_view words, std::string_view word) {
    while (!words.empty()) {
        const std::size_t end = std::min(words.find(' '), words.size());
        if (words.substr(0, end) == word) return true;
        words.remove_prefix(std::min(end + 1, words.size()));
    }
    return false;
}

}  // namespace

std::string guessAdvice(std::string_view tool, std::string_view option) {
    const auto found = std::find_if(kGuesses.begin(), kGuesses.end(), [&](const Guess& guess) {
        return (guess.tools.empty() || hasWord(guess.tools, tool)) &&
               hasWord(guess.options, option);
    });
    return found == kGuesses.end() ? "" : std::string(found->advice);
}

}  // namespace ispace
