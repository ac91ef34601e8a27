#include "tools/constriction.h"

#include <fmt/format.h>

#include <fstream>

#include "tools/cases.h"
#include "tools/saved_run.h"

namespace dmf::tools {

Findings study_constriction(const StudyOptions& options) {
  const auto run_one = [&](std::uint64_t seed) {
    ConstrictionRun run{scene_for(options, "constriction")};
    run.seed = seed;
    if (options.quick) run.time = 5;
    std::ofstream csv(fmt::format("{}/constriction_{}_seed{}.csv", options.output,
                                  file_name("red_cell" + options_key(options)), seed));
    csv << "time,x,length,width,elongation,area,volume\n";
    const ConstrictionResult r = run_constriction(run, [&csv](const ConstrictionSample& seen) {
      csv << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", seen.time, seen.x, seen.length,
                         seen.width, seen.elongation, seen.area, seen.volume);
    });
    return std::vector<double>{r.passage,      r.elongation,   r.recovered, r.width,
                               r.speed_before, r.speed_inside, r.area,      r.area_error,
                               r.volume,       r.volume_error, r.leaked};
  };
  const std::string cell = "red_cell";
  const Results results =
      run_cases("constriction",
                {"passage", "elongation", "recovered", "width", "speed_before", "speed_inside", "area",
                 "area_error", "volume", "volume_error", "leaked"},
                {{cell, run_one}}, options);
  Findings findings;
  const auto add = [&](const char* column, const char* title, int decimals) -> Finding& {
    findings.push_back(results.finding(cell, column, title, decimals));
    return findings.back();
  };
  add("passage", "from front in to rear out of the throat (tau)", 1);
  add("elongation", "largest elongation, longest over middle radius of gyration", 2);
  add("recovered", "the same 5 r_c or more behind the throat", 2)
      .against_theory({"1", "a disc, as when placed"});
  add("width", "least width; the throat has 7 (r_c)", 2);
  add("speed_before", "speed until the front is in (r_c/tau)", 3);
  add("speed_inside", "speed from front in to rear out (r_c/tau)", 3);
  add("area", "mean area, of that when placed", 3).against_theory({"1", "kept"});
  add("area_error", "area off by at most", 3);
  add("volume", "mean volume, of that when placed", 3).against_theory({"1", "kept"});
  add("volume_error", "volume off by at most", 3);
  add("leaked", "beads that changed sides, of those inside", 3).against_theory({"0", "sealed"});
  return findings;
}

}  // namespace dmf::tools
