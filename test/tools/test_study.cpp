#include "tools/study.h"

#include <gtest/gtest.h>

#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

TEST(Study, KeyNamesOnlyWhatIsNotTheDefault) {
  StudyOptions options;
  EXPECT_EQ(options_key(options), "");
  options.contact = engine::ContactModel::coulomb;
  options.calibration = "lan2016";
  options.time_step = 0.005;
  EXPECT_EQ(options_key(options), " dt=0.005 calibration=lan2016 coulomb");
  EXPECT_EQ(file_name("friction f=0.4/0.2" + options_key(options) + " seed=1"),
            "friction_f0.4_0.2_dt0.005_calibrationlan2016_coulomb_seed1");
}

TEST(Study, SceneTakesOverTheCommandLine) {
  StudyOptions options;
  options.contact = engine::ContactModel::coulomb;
  options.calibration = "lan2016";
  options.time_step = 0.005;
  const chip::Scene scene = scene_for(options, "pickup");
  EXPECT_EQ(scene.parameters.microparticles.contact, engine::ContactModel::coulomb);
  EXPECT_TRUE(scene.calibration_file.empty()) << "Lan's own law";
  EXPECT_EQ(scene.parameters.time_step, 0.005);
  EXPECT_EQ(scene.parameters.list_skin, 0.45) << "the scene's own";
}

TEST(Study, OnlyPicksValuesAndRefusesOthers) {
  StudyOptions options;
  EXPECT_TRUE(is_wanted(options, "5"));
  options.only = {"6", "7"};
  EXPECT_FALSE(is_wanted(options, "5"));
  EXPECT_TRUE(is_wanted(options, "7"));
  EXPECT_NO_THROW(require_known(options, {"5", "6", "7"}));
  EXPECT_THROW(require_known(options, {"5", "6"}), std::runtime_error);
}

TEST(Study, EveryTransportStudyHasAScene) {
  const std::vector<StudyTitle> studies = transport_studies();
  EXPECT_EQ(studies.size(), 10u);
  for (const StudyTitle& study : studies) {
    chip::Scene scene = scene_for({}, study.name);
    ASSERT_FALSE(scene.microparticles.empty()) << study.name;
    shorten_the_approach(scene);
    const engine::DropletPlacement& droplet = scene.droplets.at(0);
    EXPECT_LT(droplet.center.x() + droplet.radius, scene.microparticles[0].center.x()) << study.name;
  }
}

}  // namespace
}  // namespace dmf::tools
