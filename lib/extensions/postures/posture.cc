// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies are those of humanParts(), bent at fixed joints: no anthropometry beyond shares of the
// height. An arm is an isosceles triangle of two halves with the elbow below the line from shoulder
// to hand; its balls lie at most two thirds of their radius apart, so that the outline between two
// of them dents by 6 % of the radius. Masses and strength do not limit a posture; things do, see
// checkBody().
#include "extensions/postures/posture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "env/body_shapes.h"
#include "env/element_schemas.h"
#include "extensions/postures/deeds.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "record/schema.h"
#include "scene/placement_schemas.h"
#include "scene/thing_kind.h"
#include "sim/collision.h"

namespace ispace::postures {

namespace {

// As shares of the height, besides those of humanParts().
constexpr double kShank = 0.28;  // at most, from the seat down
constexpr double kElbow = 0.24;  // of a sitting person, below the shoulder
constexpr double kLeastReach = 0.05;
constexpr double kSpacing = 2.0 / 3;  // of the balls of an arm, in their radii

/// The solids of a standing person that all postures are made of.
struct Usual {
    explicit Usual(double height) : parts(humanParts(height)) {}
    [[nodiscard]] const BodyPart& leg() const { return parts[0]; }
    [[nodiscard]] const BodyPart& sleeve() const { return parts[1]; }
    [[nodiscard]] const BodyPart& hand() const { return parts[2]; }
    [[nodiscard]] const BodyPart& trunk() const { return parts[6]; }
    [[nodiscard]] const BodyPart& head() const { return parts[7]; }
    /// Length of a part along its axis.
    static double lengthOf(const BodyPart& part) { return part.top - part.bottom; }
    /// Distance of an arm or a leg from the middle.
    static double asideOf(const BodyPart& part) { return std::abs(part.center.y); }

    std::vector<BodyPart> parts;
};

/// Adds parts with their bottoms at heights above a floor or seat.
class FigureBuilder {
  public:
    explicit FigureBuilder(double support) : support_(support) {}

    /// Adds a box from x = `from` to `to`, whose middle lies at y.
    void addBox(double from, double to, double y, double half_width, double bottom, double top,
                Material material, bool faces_down = false) {
        parts_.push_back({.center = {(from + to) / 2, y},
                          .half_length = std::abs(to - from) / 2,
                          .half_width = half_width,
                          .bottom = support_ + bottom,
                          .top = support_ + top,
                          .faces_down = faces_down,
                          .material = material});
    }
    /// Adds a ball about a point of the person's frame.
    void addBall(Point3 middle, double radius, Material material) {
        parts_.push_back({.center = {middle.x, middle.y},
                          .radius = radius,
                          .bottom = middle.z - radius,
                          .top = middle.z + radius,
                          .is_ball = true,
                          .material = material});
    }
    /// Adds the head, with its middle above the floor or seat.
    void addHead(Point3 middle, const BodyPart& head) {
        addBall({middle.x, middle.y, support_ + middle.z}, head.radius, head.material);
    }
    void addCylinder(Point2 center, double radius, double bottom, double top, Material material) {
        parts_.push_back({.center = center,
                          .radius = radius,
                          .bottom = support_ + bottom,
                          .top = support_ + top,
                          .material = material});
    }
    /// Adds a box or a cylinder that stands at a point of the person's frame.
    void addThing(Point3 foot, Vec3 size, bool is_round) {
        parts_.push_back({.center = foot.onFloor(),
                          .half_length = is_round ? 0 : size.x / 2,
                          .half_width = is_round ? 0 : size.y / 2,
                          .radius = is_round ? size.x / 2 : 0,
                          .bottom = foot.z,
                          .top = foot.z + size.z,
                          .material = Material::Box});
    }
    [[nodiscard]] const std::vector<BodyPart>& parts() const { return parts_; }

  private:
    double support_;
    std::vector<BodyPart> parts_;
};

double reachOf(const BodyPart& part) {
    if (part.radius > 0) return length(part.center - Point2{}) + part.radius;
    return std::hypot(std::abs(part.center.x) + part.half_length,
                      std::abs(part.center.y) + part.half_width);
}

Vec3 directionOf(const ArmPose& arm) {
    const CosSin yaw = cosSin(arm.yaw), pitch = cosSin(arm.pitch);
    return {pitch.cos * yaw.cos, pitch.cos * yaw.sin, pitch.sin};
}

/// Adds both halves of an arm and the hand, as rows of balls.
void addArm(const PersonPosture& posture, const Usual& usual, const ArmPose& arm, double side,
            FigureBuilder& figure) {
    const double radius = usual.sleeve().radius;
    const double whole = longestReach(posture.height), half = whole / 2;
    const Point3 shoulder = shoulderOf(posture, side);
    const Vec3 along = directionOf(arm);
    const CosSin yaw = cosSin(arm.yaw), pitch = cosSin(arm.pitch);
    const Vec3 down{pitch.sin * yaw.cos, pitch.sin * yaw.sin, -pitch.cos};
    const double bend = std::sqrt(std::max(0.0, half * half - arm.reach * arm.reach / 4));
    const Point3 elbow = shoulder + (arm.reach / 2) * along + bend * down;
    const Point3 hand = shoulder + arm.reach * along;
    const int count = static_cast<int>(std::ceil(half / (kSpacing * radius)));
    // A hand begins where the sleeve ends.
    const double skin = whole + radius - Usual::lengthOf(usual.hand());
    const auto add = [&](Point3 from, Point3 to, int first, double before) {
        for (int i = first; i <= count; ++i) {
            const double share = static_cast<double>(i) / count;
            figure.addBall(from + share * (to - from), radius,
                           before + share * half > skin ? Material::Skin : Material::Cloth);
        }
    };
    add(shoulder, elbow, 0, 0);
    add(elbow, hand, 1, half);
}

void addTrunkAndHead(const Usual& usual, FigureBuilder& figure) {
    const BodyPart& trunk = usual.trunk();
    const double tall = Usual::lengthOf(trunk);
    figure.addBox(-trunk.half_length, trunk.half_length, 0, trunk.half_width, 0, tall,
                  trunk.material);
    const BodyPart& head = usual.head();
    figure.addHead({0, 0, tall + head.radius}, head);
}

/// Adds the legs of a sitting person.
void addSittingLegs(const PersonPosture& posture, const Usual& usual, FigureBuilder& figure) {
    const BodyPart& leg = usual.leg();
    const double shank = std::min(posture.support, kShank * posture.height);
    const double thigh = Usual::lengthOf(leg) - shank;
    for (const double side : {-1.0, 1.0}) {
        const double aside = side * Usual::asideOf(leg);
        figure.addBox(0, thigh, aside, leg.radius, 0, 2 * leg.radius, leg.material);
        if (shank > 0)
            figure.addCylinder({thigh - leg.radius, aside}, leg.radius, -shank, 0, leg.material);
    }
}

/// Adds an arm of a sitting person: it hangs to the elbow, and the rest is level.
void addSittingArm(const PersonPosture& posture, const Usual& usual, double side,
                   FigureBuilder& figure) {
    const double r = usual.sleeve().radius, aside = side * Usual::asideOf(usual.sleeve());
    const double shoulder = Usual::lengthOf(usual.trunk());
    const double elbow = shoulder - kElbow * posture.height;
    const double wrist = Usual::lengthOf(usual.sleeve()) - kElbow * posture.height;
    figure.addCylinder({0, aside}, r, elbow, shoulder, usual.sleeve().material);
    figure.addBox(-r, wrist, aside, r, elbow - r, elbow + r, usual.sleeve().material);
    figure.addBox(wrist, wrist + Usual::lengthOf(usual.hand()), aside, r, elbow - r, elbow + r,
                  usual.hand().material);
}

/// Adds the parts of a lying person, its head ahead. \param fallen on the belly, the left arm
/// beside the head
void addLying(const Usual& usual, bool fallen, FigureBuilder& figure) {
    const BodyPart& trunk = usual.trunk();
    const double end = Usual::lengthOf(trunk) / 2;
    figure.addBox(-end, end, 0, trunk.half_width, 0, 2 * trunk.half_length, trunk.material, fallen);
    figure.addHead({end + usual.head().radius, 0, usual.head().radius}, usual.head());
    const BodyPart& leg = usual.leg();
    const BodyPart& sleeve = usual.sleeve();
    const BodyPart& hand = usual.hand();
    for (const double side : {-1.0, 1.0}) {
        figure.addBox(-end - Usual::lengthOf(leg), -end, side * Usual::asideOf(leg), leg.radius, 0,
                      2 * leg.radius, leg.material);
        const bool is_ahead = fallen && side > 0;
        const double r = sleeve.radius, way = is_ahead ? 1 : -1;
        const double shoulder = is_ahead ? end - 2 * r : end;
        const double wrist = shoulder + way * Usual::lengthOf(sleeve);
        const double aside = side * Usual::asideOf(sleeve);
        figure.addBox(shoulder, wrist, aside, r, 0, 2 * r, sleeve.material);
        figure.addBox(wrist, wrist + way * Usual::lengthOf(hand), aside, r, 0, 2 * r,
                      hand.material);
    }
}

std::optional<ArmPose> armOf(const Record& person, std::string_view key, double height) {
    if (!person.has(key)) return std::nullopt;
    const Tuple& arm = person.tuple(key);
    const auto fail = [&](const std::string& reason) {
        throw FormatError(person.finding(key, '`' + std::string(key) + "`: " + reason));
    };
    constexpr double kSteepest = 90;
    if (std::abs(arm[1]) > kSteepest)
        fail("wanted a pitch from -90 (hanging) to 90 degrees (up), found " + formatDouble(arm[1]));
    const double most = longestReach(height);
    const double reach = arm.size() > 2 ? arm[2] : kUsualReach * height;
    constexpr double kRounding = 1e-9;
    if (reach < kLeastReach || reach > most + kRounding)
        fail("wanted a reach from " + formatDouble(kLeastReach) + " to " + formatFixed(most, 3) +
             " m, found " + formatDouble(reach));
    return ArmPose{Angle::degrees(arm[0]), Angle::degrees(arm[1]), reach};
}

/// Returns true for an arm that hangs, as that of a standing person does.
bool hangs(const std::optional<ArmPose>& arm) { return !arm || arm->pitch == Angle::degrees(-90); }

/// The arm of a person that carries a thing: ahead, below the shoulder.
ArmPose carryingArm(double height) { return {Angle(), Angle::degrees(-35), kUsualReach * height}; }

/// Adds the thing that a person carries, on the right hand, or beside the head of one that lies.
/// \returns the middle of its underside
Point3 addLoad(const PersonPosture& posture, const std::optional<ArmPose>& right,
               FigureBuilder& figure) {
    const bool lies = posture.posture == Posture::Lie || posture.posture == Posture::Fallen;
    constexpr double kAhead = 0.3, kBeside = 0.3;
    const double radius = Usual(posture.height).sleeve().radius;
    Point3 at{kAhead * posture.height, -kBeside * posture.height, posture.support};
    if (!lies && right) {
        at = handOf(posture, *right, -1);
        at.z += radius;
    }
    figure.addThing(at, *posture.load, posture.is_load_round);
    return at;
}

}  // namespace

bool mayBeCarried(const Record& thing) {
    const PlacementFrame frame = standingOf(thing);
    return std::max({frame.length, frame.width, frame.height()}) <= kLargestLoad;
}

double longestReach(double height) {
    const std::vector<BodyPart> parts = humanParts(height);
    return parts[1].top - parts[2].bottom - 2 * parts[1].radius;
}

PersonPosture postureOf(const Record& person, const Record* thing) {
    PersonPosture posture;
    posture.height = person.number("height");
    if (person.has("posture")) {
        const std::string& word = person.text("posture");
        posture.posture = word == "sit"      ? Posture::Sit
                          : word == "lie"    ? Posture::Lie
                          : word == "fallen" ? Posture::Fallen
                                             : Posture::Stand;
    }
    if (posture.posture == Posture::Sit) posture.support = kSeatHeight;
    if (person.has("support") && posture.posture != Posture::Stand)
        posture.support = person.number("support");
    posture.left = armOf(person, "left_arm", posture.height);
    posture.right = armOf(person, "right_arm", posture.height);
    if (thing != nullptr) {
        const PlacementFrame frame = standingOf(*thing);
        posture.load = Vec3{frame.length, frame.width, frame.height()};
        posture.is_load_round = thing->keyword() == "cylinder" && frame.length == frame.width;
    }
    const bool lies = posture.posture == Posture::Lie || posture.posture == Posture::Fallen;
    for (const std::string_view key : {"left_arm", "right_arm"})
        if (lies && !hangs(key == "left_arm" ? posture.left : posture.right))
            throw FormatError(person.finding(
                key,
                '`' + std::string(key) + "`: the arms of a person that lies cannot be raised"));
    return posture;
}

Point3 shoulderOf(const PersonPosture& posture, double side) {
    const Usual usual(posture.height);
    const BodyPart& sleeve = usual.sleeve();
    const double hip = posture.posture == Posture::Sit ? posture.support : usual.trunk().bottom;
    return {0, side * Usual::asideOf(sleeve), hip + Usual::lengthOf(usual.trunk()) - sleeve.radius};
}

Point3 handOf(const PersonPosture& posture, const ArmPose& arm, double side) {
    return shoulderOf(posture, side) + arm.reach * directionOf(arm);
}

ArmPose armTo(const PersonPosture& posture, Point3 point, double side) {
    const Vec3 way = point - shoulderOf(posture, side);
    const double flat = std::hypot(way.x, way.y);
    return {Angle::radians(std::atan2(way.y, way.x)), Angle::radians(std::atan2(way.z, flat)),
            std::clamp(length(way), kLeastReach, longestReach(posture.height))};
}

std::shared_ptr<const PersonFigure> figureOf(const PersonPosture& posture) {
    const Usual usual(posture.height);
    const double hip = usual.trunk().bottom, depth = usual.trunk().half_length;
    PersonFigure made;
    FigureBuilder builder(posture.support);
    std::optional<ArmPose> right = posture.right;
    if (posture.load && hangs(right)) right = carryingArm(posture.height);
    const auto add_arms = [&](auto add_usual) {
        for (const double side : {-1.0, 1.0}) {
            const std::optional<ArmPose>& arm = side > 0 ? posture.left : right;
            if (arm && !(posture.posture == Posture::Stand && hangs(arm)))
                addArm(posture, usual, *arm, side, builder);
            else
                add_usual(side);
        }
    };
    made.support = posture.support;
    switch (posture.posture) {
        case Posture::Stand:
            if (hangs(posture.left) && hangs(right)) return nullptr;
            made.kept.set();
            add_arms([](double) {});
            // Sleeves and hands, the right ones first.
            if (!hangs(right)) made.kept.reset(1).reset(2);
            if (!hangs(posture.left)) made.kept.reset(4).reset(5);
            break;
        case Posture::Sit:
            made.rest = "sits";
            addTrunkAndHead(usual, builder);
            addSittingLegs(posture, usual, builder);
            add_arms([&](double side) { addSittingArm(posture, usual, side, builder); });
            made.from.z = posture.support - hip;
            break;
        case Posture::Lie:
        case Posture::Fallen: {
            const bool fallen = posture.posture == Posture::Fallen;
            made.rest = fallen ? "has fallen" : "lies";
            addLying(usual, fallen, builder);
            // On the back, or on the belly; the middle of the trunk above the origin.
            const double middle = (hip + usual.trunk().top) / 2;
            made.from = {-middle, 0, posture.support + depth};
            made.x_axis = {0, 0, fallen ? -1.0 : 1.0};
            made.y_axis = {0, fallen ? 1.0 : -1.0, 0};
            made.z_axis = {1, 0, 0};
            break;
        }
    }
    if (posture.load) {
        made.load = addLoad(posture, right, builder);
        made.load_parts = 1;
    }
    made.fixed = builder.parts();
    for (const BodyPart& part : made.fixed) made.reach = std::max(made.reach, reachOf(part));
    return std::make_shared<const PersonFigure>(std::move(made));
}

namespace {

/// Checks the bodies of people, with the elements of the room in a tree.
class BodyCheck {
  public:
    explicit BodyCheck(const Scene& scene) : scene_(&scene) {
        std::vector<Box2> boxes;
        for (const Element& element : scene.environment.elements()) {
            Box2 box;
            for (const Prism& prism : element.body.prisms)
                for (const Point2 corner : prism.footprint) box.add(corner);
            for (const Sheet& sheet : element.body.sheets)
                for (const Point2 end : {sheet.line.a, sheet.line.b}) box.add(end);
            has_meshes_ = has_meshes_ || !element.body.meshes.empty();
            boxes.push_back(box);
        }
        elements_ = BoxTree(boxes);
    }
    [[nodiscard]] std::optional<Finding> operator()(std::size_t record) const {
        const PersonPosture posture = postureOf(scene_->records[record]);
        const auto figure = figureOf(posture);
        if (figure == nullptr) return std::nullopt;
        const Pose2 pose = floorPoseOf(scene_->records[record]);
        auto finding = supportOf(record, posture, *figure, pose.position);
        return finding ? finding : wallOf(record, *figure, pose);
    }

  private:
    [[nodiscard]] const Element& element(std::size_t i) const {
        return scene_->environment.elements()[i];
    }
    /// Finds people that sit or lie in the air, or in a thing.
    [[nodiscard]] std::optional<Finding> supportOf(std::size_t record, const PersonPosture& posture,
                                                   const PersonFigure& figure, Point2 at) const;
    /// Finds the wall through which a body reaches.
    [[nodiscard]] std::optional<Finding> wallOf(std::size_t record, const PersonFigure& figure,
                                                const Pose2& pose) const;

    const Scene* scene_;
    BoxTree elements_;
    bool has_meshes_ = false;
};

std::optional<Finding> BodyCheck::supportOf(std::size_t record, const PersonPosture& posture,
                                            const PersonFigure& figure, Point2 at) const {
    constexpr double kGap = 0.02;
    // Tops of meshes are not looked up.
    if (posture.posture == Posture::Stand || has_meshes_) return std::nullopt;
    std::optional<double> top;
    elements_.search({at, at}, [&](std::size_t i) {
        if (const auto here = topAt(element(i), at)) top = std::max(top.value_or(0), *here);
    });
    const double below = top.value_or(0);
    if (std::abs(below - posture.support) <= kGap) return std::nullopt;
    const std::string& id = scene_->ids[record];
    return Finding{.element = id,
                   .at = at,
                   .message = "human " + id + ' ' + figure.rest + ' ' +
                              formatFixed(posture.support, 2) + " m above the floor, where " +
                              (top ? "a thing is " + formatFixed(below, 2) + " m high"
                                   : std::string("no thing is")),
                   .hint = "set support=" + formatFixed(below, 2) + ", or move it",
                   .source = scene_->records[record].place()};
}

std::optional<Finding> BodyCheck::wallOf(std::size_t record, const PersonFigure& figure,
                                         const Pose2& pose) const {
    std::optional<std::size_t> wall;
    for (std::size_t k = 0; k + figure.load_parts < figure.fixed.size(); ++k) {
        const BodyPart& part = figure.fixed[k];
        const Segment2 way{pose.position, pose * part.center};
        Box2 box;
        for (const Point2 end : {way.a, way.b}) box.add(end);
        elements_.search(box, [&](std::size_t i) {
            if (!partsRooms(element(i)) || (wall && *wall <= i)) return;
            const auto meets = [&](const auto& piece, const Segment2& line) {
                return piece.bottom < part.top && part.bottom < piece.top && intersects(way, line);
            };
            bool is_met = false;
            for (const Prism& prism : element(i).body.prisms)
                for (std::size_t j = 0; j < prism.footprint.size(); ++j)
                    is_met =
                        is_met || meets(prism, {prism.footprint[j],
                                                prism.footprint[(j + 1) % prism.footprint.size()]});
            for (const Sheet& sheet : element(i).body.sheets)
                is_met = is_met || meets(sheet, sheet.line);
            if (is_met) wall = i;
        });
    }
    if (!wall) return std::nullopt;
    const std::string& id = scene_->ids[record];
    return Finding{.element = id,
                   .at = pose.position,
                   .message = "human " + id + ' ' +
                              (figure.rest.empty() ? "reaches" : figure.rest) + " through " +
                              element(*wall).record.keyword() + ' ' + element(*wall).id,
                   .hint = "move or turn it",
                   .source = scene_->records[record].place()};
}

}  // namespace

std::optional<Finding> checkBody(const Scene& scene, std::size_t record) {
    return BodyCheck(scene)(record);
}

namespace {

/// Returns the reason why a person that sits, lies or has fallen does not stand up where it is.
std::string refusalToStand(const Record& before, const Record& after, const Pose2& at,
                           const Scene& scene) {
    const PersonPosture stands = postureOf(after);
    if (stands.posture != Posture::Stand || postureOf(before).posture == Posture::Stand) return "";
    const Obstacles things(scene.environment, stands.height, nullptr);
    const auto thing = things.overlap(at.position, humanRadius(stands.height));
    if (!thing) return "";
    return "there is no room to stand at " + formatFixed(at.position.x, 2) + ',' +
           formatFixed(at.position.y, 2) + ": " + scene.environment.elements()[*thing].id +
           " is there; set `at` first";
}

}  // namespace

void addPostures() {
    const auto arm = [](std::string name, const std::string& side) {
        constexpr double kTurn = 180;
        return KeySpec{.name = std::move(name),
                       .type = KeyType::Tuple,
                       .help = "of the " + side +
                               " hand, from the shoulder: yaw from the heading and pitch above "
                               "level, degrees (0,-90 hangs), and distance, metres",
                       .min_count = 2,
                       .max_count = 3,
                       .lower = -kTurn,
                       .upper = kTurn};
    };
    constexpr double kHighest = 3;
    addSceneKeys("human",
                 {{.name = "posture",
                   .type = KeyType::Choice,
                   .help = "how the person holds its body; left out: it stands",
                   .choices = {"stand", "sit", "lie", "fallen"}},
                  {.name = "support",
                   .type = KeyType::Number,
                   .unit = Unit::Length,
                   .help = "height of the seat or bed under a person that sits (0.45 without it), "
                           "lies or has fallen (0)",
                   .lower = 0,
                   .upper = kHighest},
                  arm("left_arm", "left"),
                  arm("right_arm", "right"),
                  {.name = "holds",
                   .type = KeyType::Word,
                   .help = "id of the thing that the person carries, or none, which follows from "
                           "`carried` of things"}});
    for (const char* const thing : {"cube", "cylinder"}) {
        addSceneKeys(thing, {{.name = "carried",
                              .type = KeyType::Word,
                              .help = "id of the person that has it in the right hand",
                              .role = Role::Reference}});
        addThingKind(thing, {.check = [](const Record& record) {
                         if (personWith(record).empty() || mayBeCarried(record)) return;
                         throw FormatError(record.finding(
                             "carried", "`carried`: a person carries things of at most " +
                                            formatDouble(kLargestLoad) + " m"));
                     }});
    }
    setCarryKeys("carried", "holds");
    addThingKind("human",
                 {.states = {"posture", "left_arm", "right_arm", "holds"},
                  .body_keys = {"support"},
                  .has_states =
                      [](const Record& person) {
                          return person.has("posture") || person.has("left_arm") ||
                                 person.has("right_arm") || person.has("holds");
                      },
                  .check = [](const Record& person) { postureOf(person); },
                  .refusal = refusalToStand,
                  .entities = {{"posture", "sensor", ""},
                               {"left_arm", "sensor", ""},
                               {"right_arm", "sensor", ""},
                               {"holds", "sensor", ""}},
                  .figure = [](const Record& person,
                               const Record* load) { return figureOf(postureOf(person, load)); }});
    addRecordCheck("human", [](const Scene& scene) {
        return std::function<std::optional<Finding>(std::size_t record)>(BodyCheck(scene));
    });
    addDeeds();
}

}  // namespace ispace::postures
