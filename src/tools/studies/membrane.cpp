#include <fmt/format.h>

#include <vector>

#include "tools/cases.h"
#include "tools/membrane_run.h"

namespace dmf::tools {
namespace {

struct Shape {
  std::string name;
  MembraneRun run;
};

std::vector<Shape> all_shapes(const StudyOptions& options) {
  std::vector<Shape> shapes;
  const auto add = [&](const std::string& name) -> MembraneRun& {
    shapes.push_back({name, {}});
    MembraneRun& run = shapes.back().run;
    run.time_step = options.time_step_or(run.time_step);
    run.integrator = options.integrator.value_or(run.integrator);
    if (options.quick) run.settle = run.measure = 2;
    return run;
  };
  // Spheres in a liquid: what gets through, over the length of edges.
  for (const int subdivisions : {1, 2, 3}) {
    MembraneRun& run = add(fmt::format("sphere{}", subdivisions));
    run.subdivisions = subdivisions;
    if (subdivisions == 1) run.margin = 3.3;  // its edges are long for a periodic box
  }
  {
    MembraneRun& run = add("red_cell");
    run.red_cell = true;
    run.radius = 5;
    run.subdivisions = 3;
  }
  // Of a species of its own: a_mm of its beads, a_lm with the liquid.
  const auto tighten = [](MembraneRun& run, double own, double with_liquid) {
    run.own_repulsion = own;
    run.liquid_on_membrane = with_liquid;
    run.stiffness.local_area_stiffness = 100;
  };
  {
    MembraneRun& run = add("tight_sphere2");
    run.subdivisions = 2;
    tighten(run, 25, 100);
  }
  for (const double own : {0.0, 5.0}) {
    MembraneRun& run = add(own == 0 ? "tight_sphere3_a_mm=0" : "tight_sphere3");
    run.subdivisions = 3;
    tighten(run, own, 25);
    run.stiffness.shear_modulus = 60;
  }
  // The larger one has the same between its faces that are so near to each other, in parts of its thickness
  // less.
  for (const double radius : {5.0, 8.0}) {
    MembraneRun& run = add(radius == 5 ? "tight_red_cell" : "tight_red_cell_R=8");
    run.red_cell = true;
    run.radius = radius;
    run.subdivisions = radius == 5 ? 3 : 4;
    tighten(run, radius == 5 ? 20 : 8, 50);  // its edges are shorter
  }
  // A sphere whose volume goes down to that of a red cell. The liquid goes through, so that it can.
  for (const bool flat : {true, false}) {
    MembraneRun& run = add(flat ? "deflated_flat" : "deflated");
    run.repulsion = 0;
    run.stiffness.volume_ratio = 0.64;
    run.subdivisions = 2;
    run.stiffness.volume_stiffness = 100;
    run.stiffness.area_stiffness = 200;
    run.stiffness.local_area_stiffness = 50;
    run.stiffness.shear_modulus = 5;
    run.stiffness.bending_rigidity = 15;
    run.stiffness.flat = flat;
    if (!options.quick) run.settle = 100;
  }
  return shapes;
}

}  // namespace

Findings study_membrane(const StudyOptions& options) {
  const std::vector<Shape> shapes = all_shapes(options);
  std::vector<Case> cases;
  for (const Shape& one : shapes)
    cases.push_back(
        {one.name, [=](std::uint64_t seed) {
           MembraneRun run = one.run;
           run.seed = seed;
           const MembraneResult r = run_membrane(run);
           return std::vector<double>{
               r.mean_edge,      r.area,         r.volume,       r.largest_area_error, r.largest_volume_error,
               r.reduced_volume, r.gyration.x(), r.gyration.y(), r.gyration.z(),       r.centre_thickness,
               r.inside_before,  r.inside_after, r.crossed,      r.temperature};
         }});
  const Results results =
      run_cases("membrane",
                {"mean_edge", "area", "volume", "area_error", "volume_error", "reduced_volume",
                 "gyration_short", "gyration_middle", "gyration_long", "centre_thickness", "inside_before",
                 "inside_after", "crossed", "temperature"},
                cases, options);
  Findings findings;
  for (const Shape& one : shapes) {
    const auto add = [&](const char* column, const char* title, int decimals) -> Finding& {
      findings.push_back(results.finding(one.name, column, title, decimals));
      return findings.back();
    };
    const bool deflated = one.run.stiffness.volume_ratio < 1;
    add("mean_edge", "mean edge (r_c)", 2);
    add("area", "area, of that when placed", 3).against_theory({"1", "kept"});
    add("area_error", "area off by at most, of that when placed", 3);
    add("volume", "volume, of that when placed", 3)
        .against_theory(
            {fmt::format("{:g}", one.run.stiffness.volume_ratio), deflated ? "asked for" : "kept"});
    add("volume_error", "volume off by at most, of that when placed", 3);
    add("reduced_volume", "reduced volume", 3);
    add("gyration_short", "shortest radius of gyration (r_c)", 2);
    add("gyration_middle", "middle one (r_c)", 2);
    add("gyration_long", "longest one (r_c)", 2);
    Finding& thickness = add("centre_thickness", "thickness at the centre, of the largest", 2);
    if (one.run.red_cell) thickness.against_theory({"0.32", "Evans and Fung"});
    if (one.run.repulsion > 0) {
      add("inside_before", "beads of liquid inside, before", 0);
      add("inside_after", "beads of liquid inside, after", 0);
      // Both ways: 2 is all of them.
      add("crossed", "changed sides, of those inside", 3).against_theory({"0", "sealed"});
    }
    add("temperature", "temperature (k_BT)", 4);
  }
  return findings;
}

}  // namespace dmf::tools
