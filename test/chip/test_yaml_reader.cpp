#include <gtest/gtest.h>

#include <cmath>

#include "engine/yaml_reader.h"
#include "refusal.h"

namespace dmf::engine {
namespace {

YamlReader read(const std::string& text) { return YamlReader::parse(text, "file.yaml"); }

TEST(YamlReader, BareNumbersAreReducedAndUnitsAreConverted) {
  YamlReader root =
      read("a: 15\nb: 1.5 mm\nc: 20um\nd: 2 ms\ne: 4.2 pl\nf: 1 kHz\ng: 3.14159265358979 rad\n");
  root.set_units({1e-5, 1e-13, 1e-6});
  EXPECT_DOUBLE_EQ(root.quantity("a", Dimension::length, {}), 15);
  EXPECT_DOUBLE_EQ(root.quantity("b", Dimension::length, {}), 150);
  EXPECT_DOUBLE_EQ(root.quantity("c", Dimension::length, {}), 2);
  EXPECT_DOUBLE_EQ(root.quantity("d", Dimension::time, {}), 2000);
  EXPECT_DOUBLE_EQ(root.quantity("e", Dimension::volume, {}), 4.2);
  EXPECT_DOUBLE_EQ(root.quantity("f", Dimension::frequency, {}), 1000);
  EXPECT_NEAR(root.quantity("g", Dimension::angle, {}), 180, 1e-10);
  EXPECT_NO_THROW(root.finish());
}

TEST(YamlReader, MassesAccelerationsAndForcesAreConvertedToo) {
  YamlReader root = read("a: 2 ng\nb: 9.81 m/s^2\nc: 1 nN\nd: 612\n");
  root.set_units({1e-5, 1e-13, 1e-6});
  EXPECT_DOUBLE_EQ(root.quantity("a", Dimension::mass, {}), 20);
  EXPECT_DOUBLE_EQ(root.quantity("b", Dimension::acceleration, {}), 9.81e-7);
  EXPECT_DOUBLE_EQ(root.quantity("c", Dimension::force, {}), 1e-3);
  EXPECT_DOUBLE_EQ(root.quantity("d", Dimension::mass, {}), 612);
  EXPECT_NO_THROW(root.finish());
}

TEST(YamlReader, EverythingWrongIsToldAtOnceByRisingLine) {
  YamlReader root = read("tiem_step: 0.01\nlength: 5 ms\nsub:\n  on: maybe\n  extra: 1\nangle: 200\n");
  root.set_units({1, 1, 1});
  root.number("time_step", Range::above(0));
  root.quantity("length", Dimension::length, {});
  root.mapping("sub").boolean("on");
  root.quantity("angle", Dimension::angle, {0, 180});
  EXPECT_EQ(refusal([&] { root.finish(); }),
            "file.yaml:1: time_step: missing, allowed: more than 0\n"
            "file.yaml:1: tiem_step: unknown key, did you mean `time_step`? allowed: angle, length, sub, "
            "time_step\n"
            "file.yaml:2: length: 5 ms, allowed: a finite number r_c (units: m, mm, um, nm)\n"
            "file.yaml:4: sub.on: maybe, allowed: true or false\n"
            "file.yaml:5: sub.extra: unknown key, allowed: on\n"
            "file.yaml:6: angle: 200, allowed: [0, 180] degrees (units: deg, rad)");
}

TEST(YamlReader, WhatIsNoFiniteNumberIsRefused) {
  for (const char* value : {".nan", "nan", ".inf", "-inf", "1e999", "abc", "", "[1]", "{a: 1}", "1 2", "0x10",
                            "'5'", "5 mm", "+-5", "~"}) {
    YamlReader root = read(std::string("a: ") + value + "\n");
    EXPECT_EQ(root.number("a", {}, 7.0), 7.0) << value;
    EXPECT_TRUE(holds(refusal([&] { root.finish(); }), "file.yaml:1: a: ")) << value;
  }
}

TEST(YamlReader, NumbersAreReadToTheLastBit) {
  const YamlReader root = read("a: 0.1\nb: -1.7976931348623157e308\nc: +5e-324\nd: 18446744073709551615\n");
  EXPECT_EQ(root.number("a", {}), 0.1);
  EXPECT_EQ(root.number("b", {}), -1.7976931348623157e308);
  EXPECT_EQ(root.number("c", {}), 5e-324);
  EXPECT_EQ(root.integer("d", 0, ~std::uint64_t{0}), ~std::uint64_t{0});
  EXPECT_NO_THROW(root.finish());
}

TEST(YamlReader, WholeNumbersAreWholeAndInRange) {
  for (const char* value : {"-1", "1.5", "1e3", "11", "ten", "18446744073709551616", "'3'"}) {
    YamlReader root = read(std::string("n: ") + value + "\n");
    root.integer("n", 0, 10);
    EXPECT_EQ(refusal([&] { root.finish(); }), std::string("file.yaml:1: n: ") +
                                                   (value[0] == '\'' ? "3" : value) +
                                                   ", allowed: a whole number from 0 to 10");
  }
}

TEST(YamlReader, AKeyGivenTwiceIsRefused) {
  const YamlReader root = read("a: 1\nb: {c: 1, c: 2}\na: 2\n");
  root.number("a", {});
  root.mapping("b").number("c", {});
  const std::string text = refusal([&] { root.finish(); });
  EXPECT_TRUE(holds(text, "file.yaml:3: a: given twice, first in line 1"));
  EXPECT_TRUE(holds(text, "file.yaml:2: b.c: given twice, first in line 2"));
}

TEST(YamlReader, ElementsOfListsAreNamedByTheirIndex) {
  YamlReader root = read("xs: [1, two, 3]\nps: [[1, 2], [3], [4, x]]\nds:\n  - {r: 1}\n  - 5\n  - {q: 1}\n");
  root.set_units({1, 1, 1});
  EXPECT_EQ(root.quantities("xs", Dimension::number, {}, {}), (std::vector<double>{1, 3}));
  EXPECT_EQ(root.rows("ps", Dimension::number, {}, {}, {2, 2}).size(), 1u);
  const auto mappings = root.mappings("ds");
  ASSERT_EQ(mappings.size(), 2u);
  for (const auto& mapping : mappings) mapping.number("r", {});
  const std::string text = refusal([&] { root.finish(); });
  EXPECT_TRUE(holds(text, "file.yaml:1: xs[1]: two, allowed: a finite number"));
  EXPECT_TRUE(holds(text, "file.yaml:2: ps[1]: a list of 1, allowed: a list of 2 numbers"));
  EXPECT_TRUE(holds(text, "file.yaml:2: ps[2][1]: x, allowed: a finite number"));
  EXPECT_TRUE(holds(text, "file.yaml:5: ds[1]: 5, allowed: a mapping"));
  EXPECT_TRUE(holds(text, "file.yaml:6: ds[2].r: missing"));
  EXPECT_TRUE(holds(text, "file.yaml:6: ds[2].q: unknown key"));
}

TEST(YamlReader, WhatIsNotOneMappingIsRefusedWithItsLine) {
  EXPECT_TRUE(holds(refusal([] { read("a: 1\nb: [1, 2\nc: 3\n"); }), "file.yaml:3: is not YAML"));
  for (const char* text : {"", "5", "[1, 2]", "a: 1\n---\nb: 2\n"}) {
    EXPECT_TRUE(holds(refusal([&] { read(text); }), "file.yaml:1: allowed: one mapping")) << text;
  }
  EXPECT_TRUE(holds(refusal([] { YamlReader::load("/nowhere/x.yaml"); }), "/nowhere/x.yaml: can't be read"));
  EXPECT_TRUE(holds(refusal([] { YamlReader::load("/tmp"); }), "/tmp: can't be read"));
  EXPECT_THROW(read(std::string(100000, '[')), InvalidInput) << "nesting without end";
}

TEST(YamlReader, ALengthNeedsAUnitUntilUnitsAreKnown) {
  const YamlReader root = read("a: 10 um\nb: 10\n");
  EXPECT_DOUBLE_EQ(root.quantity("a", Dimension::length, {}), 1e-5);
  root.quantity("b", Dimension::length, {});
  EXPECT_EQ(refusal([&] { root.finish(); }),
            "file.yaml:2: b: 10, allowed: a number with a unit (m, mm, um, nm)");
}

TEST(YamlReader, ViolationsFoundElsewherePointAtTheDeepestLineThereIs) {
  const YamlReader root = read("x: 1\nliquid:\n  attraction: 5\n");
  root.number("x", {});
  root.mapping("liquid").number("attraction", {});
  root.report_path("liquid.attraction: 5, allowed: (-200, 0)");
  root.report_path("liquid.repulsion: 1, allowed: 2");
  root.report_path("wall.layers: 9, allowed: [1, 8]");
  EXPECT_EQ(refusal([&] { root.finish(); }),
            "file.yaml:1: wall.layers: 9, allowed: [1, 8]\n"
            "file.yaml:2: liquid.repulsion: 1, allowed: 2\n"
            "file.yaml:3: liquid.attraction: 5, allowed: (-200, 0)");
}

TEST(YamlReader, RefusesWhatStandsBehindTheMappingInsteadOfReadingForEver) {
  // yaml-cpp 0.7 never comes to the end of the first two and takes all memory there is.
  for (const char* text : {"{a: 1}, b", ",", "{a: 1}\"x\""})
    EXPECT_TRUE(holds(refusal([&] { read(text); }), "file.yaml:1: allowed: one mapping")) << text;
}

TEST(YamlReader, TellsTheFirstViolationsAndCountsTheRest) {
  std::string text;
  for (int k = 0; k < 5000; ++k) text += "unknown" + std::to_string(k) + ": 1\n";
  const std::string said = refusal([&] { read(text).finish(); });
  EXPECT_TRUE(holds(said, "file.yaml:100: unknown99: unknown key"));
  EXPECT_FALSE(holds(said, "unknown100:"));
  EXPECT_TRUE(holds(said, "file.yaml: and 4900 more"));
}

TEST(YamlReader, RefusesFilesOfAnotherKind) {
  EXPECT_TRUE(
      holds(refusal([] { YamlReader::load("/dev/zero"); }), "/dev/zero: can't be read, allowed: a file"));
  EXPECT_TRUE(holds(refusal([] { YamlReader::load("/tmp"); }), "allowed: a file"));
  EXPECT_TRUE(holds(refusal([] { YamlReader::load(std::string(5000, 'x')); }),
                    "5000 characters, allowed: up to 4000"));
  EXPECT_TRUE(holds(refusal([] { read("a: " + std::string(2 << 20, '1')); }),
                    "2097155 bytes, allowed: up to 1048576"));
}

TEST(YamlReader, ReadsNoListThatAliasesMakeLargerThanAnyFile) {
  // 20,000 rows that are one list of 1,000 values each: twenty million values in a file of 100 kB.
  std::string text = "a: &a [0";
  for (int k = 1; k < 1000; ++k) text += ",0";
  text += "]\nrows: [*a";
  for (int k = 1; k < 20000; ++k) text += ",*a";
  YamlReader root = read(text + "]\n");
  root.integers("a", 0, 9, {});
  root.integer_rows("rows", 0, 9, {}, {});
  EXPECT_TRUE(holds(refusal([&] { root.finish(); }), "too many values, allowed: 1048576 in all lists"));
}

TEST(YamlReader, ARangeKnowsItsOpenEnds) {
  EXPECT_FALSE(Range::above(0).contains(0));
  EXPECT_TRUE(Range::at_least(0).contains(0));
  EXPECT_FALSE((Range{0, 1, false, true}).contains(1));
  EXPECT_FALSE(Range{}.contains(NAN));
  EXPECT_FALSE(Range{}.contains(INFINITY));
  EXPECT_EQ((Range{0, 80}).text(Dimension::voltage), "[0, 80] V");
}

}  // namespace
}  // namespace dmf::engine
