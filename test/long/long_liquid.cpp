// The liquid against what is known of it, and its surface tension against itself by two independent routes.
#include <fmt/format.h>

#include "engine/parameters.h"
#include "runs.h"
#include "tools/liquid.h"

namespace dmf::tools {
namespace {

TEST(Liquid, HasOneTensionByStressAndByLaplaceAndTheStatedProperties) {
  ResultTable table(fresh_table("liquid"), {"a", "b", "c", "d"});
  std::vector<Job> jobs;
  for (const int seed : {301, 302}) {
    LiquidRun how;
    how.seed = static_cast<std::uint64_t>(seed);
    jobs.push_back({fmt::format("film {}", seed), [=] {
                      const FilmResult film = run_film(how);
                      return std::vector<double>{film.density, film.tension, film.normal_pressure, 0};
                    }});
    jobs.push_back({fmt::format("droplet {}", seed), [=] {
                      const FreeDropletResult droplet = run_free_droplet(how, 8);
                      return std::vector<double>{droplet.pressure, droplet.radius, droplet.temperature,
                                                 droplet.momentum};
                    }});
    jobs.push_back({fmt::format("bulk {}", seed), [=] {
                      const BulkResult bulk = run_bulk(how);
                      return std::vector<double>{bulk.temperature, bulk.viscosity, bulk.density, 0};
                    }});
  }
  run_jobs("liquid", jobs, two_at_a_time(), table);
  const auto mean = [&](const std::string& what, std::size_t column) {
    return 0.5 * (table.row(what + " 301")[column] + table.row(what + " 302")[column]);
  };
  const engine::LiquidParameters stated;
  // Density and tension of this parameter set in the literature (Warren 2003; Arienti et al. 2011): 6.0
  // to 6.1, 7.5.
  EXPECT_NEAR(mean("film", 0), 6.05, 0.05);
  EXPECT_NEAR(mean("film", 1), 7.5, 0.3);
  EXPECT_NEAR(mean("film", 0), stated.bulk_density, 0.03);
  EXPECT_NEAR(mean("film", 1), stated.surface_tension, 0.15);
  const double laplace = (mean("droplet", 0) - mean("film", 2)) * mean("droplet", 1) / 2;
  EXPECT_NEAR(laplace, mean("film", 1), 0.05 * mean("film", 1));
  // Goal: within 1 % over 10^4 steps and more.
  EXPECT_NEAR(mean("bulk", 0), 1.0, 0.01);
  EXPECT_NEAR(mean("droplet", 2), 1.0, 0.01);
  EXPECT_NEAR(mean("bulk", 1), stated.viscosity, 0.15 * stated.viscosity);
  // 12,900 beads with |p| about 1.7 each: what rounding has added after 35,000 steps.
  EXPECT_LT(mean("droplet", 3), 0.05);
}

}  // namespace
}  // namespace dmf::tools
