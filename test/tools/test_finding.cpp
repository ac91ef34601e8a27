#include "tools/finding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dmf::tools {
namespace {

constexpr double never = std::numeric_limits<double>::quiet_NaN();

Finding found(std::vector<double> values) {
  Finding finding;
  finding.study = "pickup_size";
  finding.of = "R=5";
  finding.quantity = "passes_0";
  finding.title = "passes x = 0 at (tau)";
  finding.decimals = 0;
  finding.values = std::move(values);
  return finding;
}

// The sample standard deviation of 2, 4, 4, 4, 5, 5, 7, 9 is sqrt(32 / 7).
TEST(Finding, MeanAndSpreadAreThoseOfASample) {
  const MeanAndSpread result = mean_and_spread({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_DOUBLE_EQ(result.mean, 5);
  EXPECT_DOUBLE_EQ(result.deviation, std::sqrt(32.0 / 7));
  EXPECT_DOUBLE_EQ(result.standard_error, std::sqrt(32.0 / 7 / 8));
  EXPECT_EQ(mean_and_spread({3}).deviation, 0) << "one value has no spread";
}

TEST(Finding, RunsInWhichItDidNotHappenAreCountedAndNotAveraged) {
  EXPECT_EQ(found({2100, 2300}).ours(), "2200 +- 141");
  EXPECT_EQ(found({2100}).ours(), "2100") << "one run shows no spread";
  EXPECT_EQ(found({2100, never, 2300}).ours(), "2200 +- 141 in 2 of 3");
  EXPECT_EQ(found({never, never}).ours(), "never");
}

TEST(Finding, VerdictComparesWithThePaperFirst) {
  EXPECT_EQ(found({2200}).verdict(), "") << "nothing to compare with";
  EXPECT_EQ(found({2300}).against_paper({"2000", "Lan"}).within(0.1).verdict(), "off, +15.0 %");
  EXPECT_EQ(found({2200}).against_paper({"2000", "Lan"}).within(0.1).verdict(), "agrees, +10.0 %");
  EXPECT_EQ(found({1800}).against_paper({"about 2000", "Lan"}).within(0.05).verdict(), "off, -10.0 %");
  EXPECT_EQ(found({2200}).against_paper({"2200", "Lan"}).against_theory({"1", "theory"}).verdict(),
            "agrees, +0.0 %");
  EXPECT_EQ(found({2200}).against_theory({"2000", "theory"}).within(0.05).verdict(), "off, +10.0 %");
  EXPECT_EQ(found({2200}).against_paper({"7 times that of -18", "Lan"}).verdict(), "") << "not a number";
}

TEST(Finding, VerdictOfAStretchIsByItsNearerEnd) {
  const Reference window{"-17.5 to -12.5", "Lan"};
  EXPECT_EQ(found({-15}).against_paper(window).verdict(), "agrees");
  EXPECT_EQ(found({-12.5}).against_paper(window).verdict(), "agrees");
  EXPECT_EQ(found({-10}).against_paper(window).within(0.1).verdict(), "off, +20.0 %");
}

TEST(Finding, VerdictKnowsWhatNeverHappens) {
  const Reference not_there{"never", "Lan"};
  EXPECT_EQ(found({never, never}).against_paper(not_there).verdict(), "as there");
  EXPECT_EQ(found({never, 7000}).against_paper(not_there).verdict(), "happened in 1 of 2");
  EXPECT_EQ(found({never}).against_paper({"2317", "Lan"}).verdict(), "did not happen");
}

TEST(Finding, AMarginCountsInTheQuantitysOwnUnit) {
  Finding angle = found({131.5});
  angle.decimals = 1;
  EXPECT_EQ(angle.against_theory({"130", "commanded"}).within_margin(3).verdict(), "agrees, +1.5");
  EXPECT_EQ(angle.within_margin(1).verdict(), "off, +1.5");
  EXPECT_EQ(found({1}).against_theory({"0", "kept"}).within(0.5).verdict(), "off, +1")
      << "a share of 0 is nothing";
}

TEST(Finding, OrderIsKendallsRankCorrelation) {
  EXPECT_EQ(rank_correlation({{1, 10}, {2, 20}, {3, 30}}), 1);
  EXPECT_EQ(rank_correlation({{3, 10}, {2, 20}, {1, 30}}), -1);
  EXPECT_DOUBLE_EQ(rank_correlation({{1, 10}, {3, 20}, {2, 30}}), 1.0 / 3)
      << "one of three pairs is reversed";
  EXPECT_EQ(rank_correlation({{2, 10}, {1, 10}, {3, 30}}), 1) << "equal references have no order";
  EXPECT_TRUE(std::isnan(rank_correlation({{1, 10}})));
}

TEST(Finding, TableHasOnlyWhatCanBeCompared) {
  const Findings findings{found({2200}), found({2100, 2300}).against_paper({"2317", "Lan"}).within(0.1),
                          found({}).against_paper({"2317", "Lan"})};
  EXPECT_EQ(as_markdown(findings),
            "| `pickup_size` R=5 | passes x = 0 at (tau) | 2317 (Lan) |  | 2200 ± 141 | 2 | agrees, -5.0 % | "
            "0 |\n");
}

TEST(Finding, CsvHasAsManyFieldsAsItsHeader) {
  Finding finding = found({2200}).against_paper({"2,317", "Lan, one run"});
  const std::string csv = as_csv({finding});
  const std::size_t end = csv.find('\n');
  EXPECT_EQ(std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(end), ','),
            std::count(csv.begin() + static_cast<std::ptrdiff_t>(end), csv.end(), ','));
}

}  // namespace
}  // namespace dmf::tools
