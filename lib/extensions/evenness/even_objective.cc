// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/evenness/even_objective.h"

#include "arrange/arrange.h"
#include "base/error.h"
#include "base/number.h"
#include "extensions/evenness/even_demand.h"

namespace ispace::evenness {

namespace {

class EvenObjective : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return "even"; }
    [[nodiscard]] std::string_view help() const override {
        return "floor also for its second and third sensor";
    }
    void declare(CommandLine& line) override {
        constexpr int kDeepest = 8;
        line.group("Even coverage");
        line.count("--depth", "N", rule_.depth, 2, kDeepest, "sensors that count on one spot",
                   Enters::History);
        line.parsed(
            "--further", "SHARE",
            [this](const std::string& text) {
                constexpr double kLeast = 0.01;
                const auto share = parseShare(text);
                if (!share || *share < kLeast)
                    throw UsageError('`' + text + "` is not a share from 1% to 100%");
                rule_.share = *share;
            },
            "what a further sensor on a spot counts of the one before it (default 50%)",
            Enters::History);
    }
    [[nodiscard]] Counted counted() const override {
        static constexpr std::string_view kOfFloor[] = {"--zone", "--weight"};
        return {"cells by the number of sensors that see them", kOfFloor};
    }
    [[nodiscard]] std::vector<std::shared_ptr<const Demand>> demandsIn(
        const SiteInput& site, std::span<const RoomGoals> goals, const ArrangeOptions& how,
        const CommonOptions& /*common*/, std::vector<std::string>& /*files*/) const override {
        if (how.redundancy > 1)
            throw UsageError(
                "--objective even counts each sensor on a spot: leave out --redundancy, "
                "and give --depth");
        EvenRule rule = rule_;
        rule.plane = how.plane;
        constexpr double kHighest = 1000;  // metres: of sites
        const SeenSite seen(site);
        std::vector<std::shared_ptr<const Demand>> demands;
        for (std::size_t i = 0; i < site.rooms().size(); ++i) {
            std::shared_ptr<const Scene> scene =
                seen.coupling() != nullptr ? seen.coupling()->floor(i, kHighest) : site.rooms()[i];
            const Target target = makeTarget(scene->environment, searchCells(how), kScanHeight);
            std::vector<double> weights = weightsOfCells(target, goals[i].weights);
            if (!goals[i].counts) weights.clear();
            demands.push_back(
                std::make_shared<EvenDemand>(std::move(scene), target, weights, rule));
        }
        return demands;
    }

  private:
    EvenRule rule_ = {};
};

}  // namespace

std::unique_ptr<ObjectiveGroup> makeEvenObjective() { return std::make_unique<EvenObjective>(); }

}  // namespace ispace::evenness
