#include <gtest/gtest.h>

#include "controller/droplets.h"
#include "fake_board.h"
#include "refusal.h"

namespace dmf::controller {
namespace {

std::vector<Channels> channels_of(const std::vector<Droplet>& droplets) {
  std::vector<Channels> all;
  for (const Droplet& droplet : droplets) all.push_back(droplet.channels);
  return all;
}

TEST(Layout, OnlySidesAreNeighboursButCornersAreNear) {
  const Layout layout(grid_board(3, 3));
  EXPECT_EQ(layout.neighbours(4), (Channels{1, 3, 5, 7}));
  EXPECT_EQ(layout.near(4), (Channels{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(layout.near(0), (Channels{0, 1, 3, 4}));
  EXPECT_NEAR(layout.area(4), 0.81e-6, 1e-15);
  EXPECT_TRUE(layout.are_opposite(4, 3, 5));
  EXPECT_FALSE(layout.are_opposite(4, 1, 5));
}

TEST(Layout, OverAHoleNothingIsNear) {
  const Layout layout(grid_board(3, 1, {1}));
  EXPECT_EQ(layout.near(0), (Channels{0}));
}

TEST(Layout, ABoardThatCannotBeIsRefusedWhole) {
  BoardDescription board = grid_board(2, 1);
  board.electrodes[0].neighbours.push_back(7);
  board.electrodes.push_back(board.electrodes[1]);
  board.sensing.liquid_capacitance = board.sensing.filler_capacitance;
  const std::string refused = refusal([&] { Layout{board}; });
  EXPECT_TRUE(holds(refused, "channel 1: given twice"));
  EXPECT_TRUE(holds(refused, "channel 0: neighbour 7 does not exist"));
  EXPECT_TRUE(holds(refused, "liquid capacitance"));
}

TEST(Wetting, FollowsFromTheFractionsThatMadeTheCapacitance) {
  FakeBoard board(grid_board(3, 1));
  board.amount = {{0, 0.25}, {1, 1}};
  const Wetting wetting = wetting_of(Layout(grid_board(3, 1)), board.read());
  EXPECT_NEAR(wetting.at(0), 0.25, 1e-12);
  EXPECT_NEAR(wetting.at(1), 1, 1e-12);
  EXPECT_NEAR(wetting.at(2), 0, 1e-12);
}

TEST(DropletFinder, ConnectedWettedElectrodesAreOneDroplet) {
  const Layout layout(grid_board(4, 2));
  DropletFinder finder(layout, 0.3);
  finder.update({{0, 1}, {1, 0.5}, {2, 0.1}, {3, 0.9}, {4, 0}, {5, 0.2}, {6, 0}, {7, 0.4}});
  ASSERT_EQ(channels_of(finder.droplets()), (std::vector<Channels>{{0, 1}, {3, 7}}));
  EXPECT_EQ(finder.droplets()[0].main, 0u);
  EXPECT_NEAR(finder.droplets()[1].covered, 1.3, 1e-12);
  EXPECT_EQ(finder.on(7), &finder.droplets()[1]);
  EXPECT_EQ(finder.on(2), nullptr);
}

TEST(DropletFinder, ADropletKeepsItsIdWhileItMovesMergesAndSplits) {
  const Layout layout(grid_board(5, 1));
  DropletFinder finder(layout, 0.3);
  const auto ids = [&](const Wetting& wetting) {
    std::map<Channel, std::uint32_t> on;
    for (const Droplet& droplet : finder.update(wetting)) on[droplet.main] = droplet.id;
    return on;
  };
  using Ids = std::map<Channel, std::uint32_t>;
  EXPECT_EQ(ids({{0, 1}, {4, 1}}), (Ids{{0, 1}, {4, 2}}));
  EXPECT_EQ(ids({{1, 1}, {4, 1}}), (Ids{{1, 1}, {4, 2}})) << "jumped between two readings";
  EXPECT_EQ(ids({{2, 0.4}, {3, 0.5}, {4, 1}}), (Ids{{4, 2}})) << "merged: the larger part goes on";
  EXPECT_EQ(ids({{2, 0.5}, {4, 0.9}}), (Ids{{2, 3}, {4, 2}})) << "split: what is new has a new id";
}

}  // namespace
}  // namespace dmf::controller
