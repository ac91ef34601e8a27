#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "controller/route.h"
#include "fake_board.h"

namespace dmf::controller {
namespace {

constexpr int kColumns = 5, kRows = 4;

/// The constraints of Su, Hwang and Chakrabarty as they stand in the paper, in columns and rows.
bool far_apart(Channel a, Channel b) {
  const int dx = std::abs(static_cast<int>(a % kColumns) - static_cast<int>(b % kColumns));
  const int dy = std::abs(static_cast<int>(a / kColumns) - static_cast<int>(b / kColumns));
  return dx >= 2 || dy >= 2;
}

bool keeps_clear(Channel from, Channel to, Channel other_from, Channel other_to) {
  return far_apart(to, other_to) && far_apart(to, other_from) && far_apart(from, other_to);
}

/// Fewest steps to the destination by trying every way at once, time by time. -1: there is none.
int fewest_steps(const Layout& layout, Channel from, Channel to, const Traveller& other) {
  const std::size_t horizon = 4 * layout.channels().size() + other.cells.size();
  const auto can_stay = [&](std::size_t time) {
    for (std::size_t later = time; later < horizon; ++later)
      if (!keeps_clear(to, to, other.at(later), other.at(later + 1))) return false;
    return true;
  };
  Channels reached{from};
  for (std::size_t time = 0; time < horizon; ++time) {
    if (reached.count(to) && can_stay(time)) return static_cast<int>(time);
    Channels next;
    for (const Channel cell : reached) {
      Channels ways = layout.neighbours(cell);
      ways.insert(cell);
      for (const Channel way : ways)
        if (keeps_clear(cell, way, other.at(time), other.at(time + 1))) next.insert(way);
    }
    reached = next;
  }
  return -1;
}

TEST(Route, IsTheShortestAroundAHole) {
  const Layout layout(grid_board(5, 3, {7}));
  const auto route = find_route(layout, {6, {8}, false, 0, {}, 0}, {});
  ASSERT_TRUE(route);
  EXPECT_EQ(route->size(), 5u);
  EXPECT_EQ(route->front(), 6u);
  EXPECT_EQ(route->back(), 8u);
  for (std::size_t k = 1; k < route->size(); ++k)
    EXPECT_TRUE(layout.are_neighbours((*route)[k - 1], (*route)[k]));
}

TEST(Route, AroundAMovingDropletKeepsTheConstraintsAndTakesFewestSteps) {
  const Layout layout(grid_board(kColumns, kRows));
  std::mt19937 random(5);
  const auto any_cell = [&] { return static_cast<Channel>(random() % (kColumns * kRows)); };
  int with_way = 0, waited = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Traveller other{7, {any_cell()}, 0};
    while (other.cells.size() < 8) {
      const Channels& ways = layout.neighbours(other.cells.back());
      other.cells.push_back(*std::next(ways.begin(), static_cast<int>(random() % ways.size())));
    }
    const Channel from = any_cell(), to = any_cell();
    if (!far_apart(from, other.cells[0])) continue;
    const auto route = find_route(layout, {from, {to}, false, 0, {}, 0}, {{other}, {}, {}});
    const int fewest = fewest_steps(layout, from, to, other);
    ASSERT_EQ(route ? static_cast<int>(route->size()) - 1 : -1, fewest) << from << " to " << to;
    if (!route) continue;
    ++with_way;
    const Traveller found{1, *route, 0};
    for (std::size_t time = 0; time < 20; ++time)
      ASSERT_TRUE(keeps_clear(found.at(time), found.at(time + 1), other.at(time), other.at(time + 1)));
    waited += static_cast<int>(route->size()) - 1 >
              std::abs(static_cast<int>(from % 5) - static_cast<int>(to % 5)) +
                  std::abs(static_cast<int>(from / 5) - static_cast<int>(to / 5));
  }
  EXPECT_GT(with_way, 100);
  EXPECT_GT(waited, 20) << "the other was in the way";
}

TEST(Route, AGivenWayIsKeptAndWaitsWhereItMust) {
  const Layout layout(grid_board(5, 4));
  const Traveller crossing{2, {2, 7, 12, 17, 17}, 0};
  const auto route = find_route(layout, {10, {11, 12, 13, 14}, true, 0, {}, 0}, {{crossing}, {}, {}});
  EXPECT_FALSE(route) << "the other stays beside the way";
  const Traveller ahead{2, {12, 13, 14, 9, 4}, 0};
  const auto free = find_route(layout, {10, {11, 12}, true, 0, {}, 0}, {{ahead}, {}, {}});
  ASSERT_TRUE(free);
  EXPECT_EQ(*free, (std::vector<Channel>{10, 10, 11, 12}));
}

TEST(Route, KeepsAnElectrodeFreeAroundStandingDropletsAndDeadElectrodesOut) {
  const Layout layout(grid_board(5, 4));
  const Surroundings around{{}, {{3, {7}, 0}}, {18}};
  EXPECT_FALSE(find_route(layout, {0, {4}, false, 0, {}, 0}, around))
      << "a droplet in row 1 closes rows 0 to 2, 18 row 3";
  EXPECT_EQ(why_no_route(layout, {0, {4}, false, 0, {}, 0}, around), "blocked by droplet 3");
  EXPECT_TRUE(find_route(layout, {0, {4}, false, 0, {}, 0}, {{}, {{3, {7}, 0}}, {}}));
  EXPECT_TRUE(find_route(layout, {0, {4}, false, 0, {3}, 0}, around))
      << "it may touch the one that it shall merge with";
  EXPECT_FALSE(find_route(layout, {0, {4}, false, 1, {}, 0}, {{}, {{3, {7}, 0}}, {}}))
      << "a large one needs more room";
}

TEST(Route, WhatIsInTheWayIsNamed) {
  const Layout line(grid_board(7, 1));
  EXPECT_EQ(why_no_route(line, {0, {6}, false, 0, {}, 0}, {{}, {{3, {3}, 0}}, {}}), "blocked by droplet 3");
  EXPECT_EQ(why_no_route(line, {0, {6}, false, 0, {}, 0}, {{}, {{4, {6}, 0}, {3, {3}, 0}}, {}}),
            "blocked by droplet 3 and droplet 4");
  EXPECT_EQ(why_no_route(line, {0, {6}, false, 0, {}, 0}, {{}, {}, {2, 3}}),
            "no way from channel 0 to 6: electrodes 2-3 do not answer");
  const Layout broken(grid_board(7, 1, {3}));
  EXPECT_EQ(why_no_route(broken, {0, {6}, false, 0, {}, 0}, {}), "no way from channel 0 to 6");
}

TEST(Route, WhoStandsTooNearMayLeave) {
  const Layout layout(grid_board(5, 1));
  EXPECT_TRUE(find_route(layout, {1, {3}, false, 0, {}, 0}, {{}, {{2, {0}, 0}}, {}}));
  EXPECT_FALSE(find_route(layout, {2, {1}, false, 0, {}, 0}, {{}, {{2, {0}, 0}}, {}}));
}

}  // namespace
}  // namespace dmf::controller
