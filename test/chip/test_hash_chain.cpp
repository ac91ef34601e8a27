#include <gtest/gtest.h>

#include <vector>

#include "chip/hash_chain.h"

namespace dmf::chip {
namespace {

const std::vector<CommandRecord> kHistory{
    {120, SetHv{63, 1000, true}}, {120, SetElectrodes{{1}}}, {310, SetElectrodes{{2, 3}}}};

/// The chain's value after links at 0, 100, 200, 300 and 400, asked for other records in between.
std::uint64_t last_value(const std::vector<CommandRecord>& history, std::uint64_t scene, std::uint64_t seed,
                         const std::vector<std::uint64_t>& in_between = {}) {
  HashChain chain(scene, seed, 100);
  const auto add = [&](std::uint64_t step) {
    std::size_t given = 0;
    while (given < history.size() && history[given].step < step) ++given;
    chain.add(step, 1000 + step, history, given);
  };
  for (std::uint64_t step = 0; step <= 400; ++step) {
    if (step % 100 == 0) add(step);
    for (const std::uint64_t extra : in_between)
      if (extra == step) add(step);
  }
  return chain.last()->chain;
}

TEST(HashChain, StandsForSceneSeedAndEveryCommand) {
  const std::uint64_t value = last_value(kHistory, 1, 2);
  EXPECT_EQ(last_value(kHistory, 1, 2), value);
  EXPECT_NE(last_value(kHistory, 2, 1), value);
  EXPECT_NE(last_value(kHistory, 1, 3), value);
  for (std::size_t i = 0; i < kHistory.size(); ++i) {
    auto altered = kHistory;
    altered[i].step += 1;
    EXPECT_NE(last_value(altered, 1, 2), value) << i;
    altered = kHistory;
    altered[i].command = SetElectrodes{{7}};
    EXPECT_NE(last_value(altered, 1, 2), value) << i;
    altered = kHistory;
    altered.erase(altered.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(last_value(altered, 1, 2), value) << i;
  }
  auto swapped = kHistory;
  std::swap(swapped[0], swapped[1]);
  EXPECT_NE(last_value(swapped, 1, 2), value);
}

TEST(HashChain, DoesNotDependOnWhoAsksInBetween) {
  EXPECT_EQ(last_value(kHistory, 1, 2, {50, 130, 131, 315, 399}), last_value(kHistory, 1, 2));
}

TEST(HashChain, ARecordBetweenTwoLinksKnowsTheCommandsSinceTheLink) {
  HashChain with(1, 2, 100), without(1, 2, 100);
  EXPECT_EQ(with.add(0, 5, {}).chain, without.add(0, 5, {}).chain);
  const StateRecord a = with.add(150, 6, kHistory, 2), b = without.add(150, 6, kHistory, 1);
  EXPECT_NE(a.chain, b.chain);
  EXPECT_EQ(a.index, 1u);
  EXPECT_EQ(a.commands, 2u);
}

TEST(HashChain, StartsAnywhereAsThatOfARunFromACheckpointDoes) {
  HashChain chain(1, 2, 100);
  chain.add(137, 5, kHistory, 2);
  EXPECT_FALSE(chain.is_link(150));
  EXPECT_TRUE(chain.is_link(200));
  EXPECT_TRUE(chain.has(137, 2));
  EXPECT_FALSE(chain.has(137, 3));
}

TEST(HashChain, GoesOnFromALinkThatIsTakenOnTrust) {
  HashChain whole(1, 2, 100), adopted(7, 7, 100);
  whole.add(0, 5, kHistory, 0);
  adopted.adopt(whole.add(100, 6, kHistory, 0));
  const StateRecord next = whole.add(200, 7, kHistory, 2), same = adopted.add(200, 7, kHistory, 2);
  EXPECT_EQ(next.chain, same.chain);
  EXPECT_EQ(next.index, same.index);
}

TEST(Fingerprint, IsOfRolesAndTextsAndNotOfPlaces) {
  const std::vector<SceneFile> files{{"scene", "/a/x.yaml", "seed: 1"}, {"board", "/a/b.json", "{}"}};
  const auto of = [](std::vector<SceneFile> all) {
    return fingerprint(SceneFiles::recorded(std::move(all)));
  };
  auto other = files;
  other[0].path = "/elsewhere/x.yaml";
  EXPECT_EQ(of(other), of(files));
  other[0].text = "seed: 2";
  EXPECT_NE(of(other), of(files));
  other = files;
  other[1].role = "calibration";
  EXPECT_NE(of(other), of(files));
  EXPECT_NE(of({files[0]}), of(files));
}

}  // namespace
}  // namespace dmf::chip
