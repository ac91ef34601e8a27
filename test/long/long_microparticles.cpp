// What Lan's microparticles do, chapters 3 and 4. His numbers are single runs.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "runs.h"
#include "tools/trajectory.h"

namespace dmf::tools {
namespace {

/// Trajectories of a scene over seeds, two at a time. A droplet may pass a microparticle by
/// (docs/validation/microparticles.md): those that did are left out.
std::vector<Trajectory> trajectories(const std::string& name, const chip::Scene& scene, int seeds,
                                     double goal, double limit) {
  const StudyOptions options = two_at_a_time(name, seeds);
  constexpr int first_seed = 401;
  std::vector<std::vector<TransportRecord>> records(static_cast<std::size_t>(seeds));
  run_cases(name, {"done"},
            {{"",
              [&](std::uint64_t seed) {
                TransportRun run;
                run.goal = goal;
                run.limit = limit;
                run.folder = options.output + "/runs";
                run.key = fmt::format("seed{}", seed);
                records[seed - first_seed] = run_transport(scene, seed, run).records;
                return std::vector<double>{1};
              }}},
            options, first_seed);
  std::vector<Trajectory> found;
  for (const auto& one : records) {
    const Trajectory trajectory(one, 1);
    if (!std::isnan(trajectory.time_picked_up())) found.push_back(trajectory);
  }
  return found;
}

double mean_of(const std::vector<Trajectory>& all, const std::function<double(const Trajectory&)>& value) {
  std::vector<double> values;
  for (const Trajectory& one : all) values.push_back(value(one));
  return mean_and_spread(values).mean;
}

chip::Scene pickup(double radius, double attraction) {
  chip::Scene scene = chip::load_scene("pickup");
  scene.droplets.at(0).radius = radius;
  scene.droplets.at(0).center.z() = scene.parameters.domain.lower.z() + radius;
  scene.microparticles.at(0).attraction = attraction;
  return scene;
}

TEST(Pickup, LargerDropletsCarryItFasterAndLeaveItOnTheWall) {
  // -30 -> 0: 2,317 for R = 5 and 1,324 for R = 7; ours have been 2,344 +- 201 (9 seeds) and 1,327 to 1,393
  // (3). On the wall all the time, at a mean height of 0.99751; ours 0.99772, in contact in 0.945 of all
  // steps.
  const auto at_zero = [](const Trajectory& one) { return one.time_at(0); };
  const auto small = trajectories("pickup_5", pickup(5, -15), 3, 0, 4500);
  const auto large = trajectories("pickup_7", pickup(7, -15), 2, 0, 2500);
  ASSERT_GE(small.size(), 1u);
  ASSERT_GE(large.size(), 1u);
  const double slow = mean_of(small, at_zero), fast = mean_of(large, at_zero);
  EXPECT_NEAR(slow, 2317, 0.2 * 2317);
  EXPECT_NEAR(fast / slow, 1324.0 / 2317, 0.12);
  for (const Trajectory& one : small) {
    EXPECT_NEAR(one.mean_height(), 0.99751, 0.0005);
    EXPECT_GT(one.contact_fraction(), 0.9);
  }
}

TEST(Pickup, AHydrophilicMicroparticleLiftsOffAndIsCarriedFaster) {
  // Lan: lifted at 150 tau at A_ls -19.5 and at 1,153 at -18, and carried without friction from then on. Ours
  // is later, 165 to 460 (6 seeds); -18 at 775 to 1,315 (3 seeds).
  const auto runs = trajectories("pickup_wetting", pickup(5, -19.5), 3, 20, 3000);
  ASSERT_GE(runs.size(), 1u);
  for (const Trajectory& one : runs) {
    EXPECT_LT(one.time_lifted(), 0.5 * 1153);
    EXPECT_LT(one.x_at(one.time_lifted()), -15);
    EXPECT_LT(one.contact_fraction(), 0.1);
    EXPECT_LT(one.time_at(20), 2500);
  }
}

TEST(ActiveDelivery, LeavesTheMicroparticleBetweenMinusTwoAndTwo) {
  const chip::Scene scene = chip::load_scene("active_delivery");
  const auto runs = trajectories("active_delivery", scene, 2, INFINITY, 13000);
  ASSERT_GE(runs.size(), 1u);
  for (const Trajectory& one : runs) {
    EXPECT_NEAR(one.final_x(), 0, 2);
    EXPECT_GT(one.final_droplet_x(), 8);
    EXPECT_GT(one.time_dropped_off(), 12000);
  }
}

}  // namespace
}  // namespace dmf::tools
