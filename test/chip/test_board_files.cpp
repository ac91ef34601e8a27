#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "chip/board_file.h"
#include "chip/polygon.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

const std::string kBoards = DMF_SOURCE_DIR "/config/boards/";

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A drawing whose unit is a millimetre.
std::string svg(const std::string& elements,
                const std::string& metadata = "<metadata><scale>1</scale></metadata>") {
  return "<svg xmlns='http://www.w3.org/2000/svg'>\n" + metadata + "\n" + elements + "\n</svg>";
}
std::string pad(const std::string& path_data, int channel = 1) {
  return "<path data-channels='" + std::to_string(channel) + "' d='" + path_data + "'/>";
}
std::string json(const std::string& layout) { return "{\"layout\": {" + layout + "}}"; }
std::string electrode(const std::string& polygon, int pin = 1) {
  return "{\"id\": \"A\", \"pin\": " + std::to_string(pin) + ", \"polygon\": " + polygon + "}";
}
std::string peripheral(const std::string& electrodes, const std::string& more = "\"origin\": [0, 0]") {
  return json("\"peripherals\": [{" + more + ", \"electrodes\": [" + electrodes + "]}]");
}

std::string refused_svg(const std::string& text) {
  return refusal([&] { parse_board_file(text, "board.svg", {}); });
}
std::string refused_json(const std::string& text) {
  return refusal([&] { parse_board_file(text, "board.json", {}); });
}

const Electrode& of(const BoardFile& board, std::uint32_t channel) {
  for (const Electrode& electrode : board.electrodes)
    if (electrode.channel == channel) return electrode;
  throw std::out_of_range("no channel " + std::to_string(channel));
}
double area_mm2(const BoardFile& board, std::uint32_t channel) {
  return area(of(board, channel).outline) * 1e6;
}
::testing::AssertionResult is_at_mm(const Vector2d& place_m, double x, double y) {
  if ((place_m * 1e3 - Vector2d(x, y)).norm() < 1e-9) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "at " << place_m.transpose() * 1e3 << " mm";
}

// The drawing of config/boards/purpledrop_example.json reaches from x 4 to 23 and y 2 to 16 mm, y down, so
// its middle is (13.5, 9).
TEST(PurpledropBoard, PadsStandWhereTheGridPutsThem) {
  const BoardFile board = read_board_file(kBoards + "purpledrop_example.json", {});
  EXPECT_EQ(board.electrodes.size(), 15u)
      << "3 + 5 + 3 in the grid, holes are null or -1, and 2 reservoirs of 2";
  EXPECT_NEAR(board.pitch_m, 2.5e-3, 1e-15);
  EXPECT_NEAR(board.drawn_gap_m, 0, 1e-15);
  EXPECT_TRUE((board.extent_m * 1e3).isApprox(Vector2d(19, 14)));
  // Pin 21 is column 1, row 1: from 4 + 2.5 and 2 + 2.5 on, 2.5 wide, the middle at (7.75, 5.75).
  EXPECT_TRUE(is_at_mm(of(board, 21).centroid, 7.75 - 13.5, 9 - 5.75));
  EXPECT_NEAR(area_mm2(board, 21), 6.25, 1e-9);
  EXPECT_TRUE(is_at_mm(of(board, 32).centroid, 12.75 - 13.5, 9 - 8.25))
      << "column 3, row 2: y points up for us";
}

TEST(PurpledropBoard, PeripheralsAreMovedByBothOriginsAndTurnedAboutTheirOwn) {
  const BoardFile board = read_board_file(kBoards + "purpledrop_example.json", {});
  // A trapezoid that widens from 2.5 to 5 over 1, and 3 x 5: 3.75 + 15.
  EXPECT_NEAR(area_mm2(board, 41), 18.75, 1e-9);
  EXPECT_NEAR(area_mm2(board, 51), 18.75, 1e-9);
  // Its centroid lies (3.75 * 5/9 + 15 * 2.5) / 18.75 = 19/9 from its narrow end, and that 2.5 from the
  // origin.
  const double away = 2.5 + 19.0 / 9;
  EXPECT_TRUE(is_at_mm(of(board, 41).centroid, 16.5 + away - 13.5, 9 - 5.75)) << "not turned: to the right";
  EXPECT_TRUE(is_at_mm(of(board, 51).centroid, 10.25 - 13.5, 9 - (9.5 + away)))
      << "a quarter turn: down the screen";
}

TEST(PurpledropBoard, AnElectrodesOwnValuesGoBeforeItsTemplates) {
  const std::string layout = R"("peripheral_templates": {"T": {"electrodes": [
      {"id": "A", "polygon": [[0, 0], [1, 0], [1, 1]], "origin": [0, 0]}]}},
    "peripherals": [{"type": "T", "origin": [0, 0], "electrodes": [
      {"id": "A", "pin": 1}, {"id": "A", "pin": 2, "origin": [5, 0]},
      {"id": "A", "pin": 3, "origin": [9, 0], "polygon": [[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]},
      {"id": "A", "pin": null}]}])";
  const BoardFile board = parse_board_file(json(layout), "board.json", {});
  ASSERT_EQ(board.electrodes.size(), 3u) << "a peripheral's electrode without a pin is none";
  EXPECT_NEAR(area_mm2(board, 1), 0.5, 1e-9);
  EXPECT_NEAR((of(board, 2).centroid - of(board, 1).centroid).x(), 5e-3, 1e-12);
  EXPECT_NEAR(area_mm2(board, 3), 4, 1e-9);
  EXPECT_EQ(of(board, 3).outline.size(), 4u) << "a first corner that is repeated at the end is no corner";
}

TEST(PurpledropBoard, AnOldGridHasNoMillimetresOfItsOwn) {
  const std::string old = json("\"grid\": [[7, null], [-1, 3]]");
  EXPECT_TRUE(holds(refused_json(old), "`layout.grid` counts in grid units, allowed: with `file_unit`"));
  BoardFileOptions options;
  options.unit_m = 2.75e-3;
  const BoardFile board = parse_board_file(old, "board.json", options);
  EXPECT_NEAR(board.pitch_m, 2.75e-3, 1e-15);
  EXPECT_TRUE(is_at_mm(of(board, 7).centroid, -2.75 / 2, 2.75 / 2));
  EXPECT_TRUE(is_at_mm(of(board, 3).centroid, 2.75 / 2, -2.75 / 2));
}

// config/boards/microdrop_example.svg has <scale>0.01</scale>: 0.01 mm^2 for a square unit, 0.1 mm for a
// unit.
TEST(MicrodropBoard, ScaleIsOfAreaSoLengthsFollowItsRoot) {
  const BoardFile board = read_board_file(kBoards + "microdrop_example.svg", {});
  EXPECT_EQ(board.electrodes.size(), 9u);
  for (const std::uint32_t channel : {0, 1, 2, 3, 4, 10, 11})
    EXPECT_NEAR(area_mm2(board, channel), 4, 1e-9) << channel << ": 20 x 20 units, however it is written";
  EXPECT_NEAR(area_mm2(board, 12), 4 + 0.5 * M_PI, 0.01 * 0.5 * M_PI) << "and half a circle of 1 mm";
  // The end of the reservoir, y = 30 t (1 - t) over dx = 120 t (1 - t) dt, has 3600 B(3, 3) = 120 square
  // units.
  EXPECT_NEAR(area_mm2(board, 20), 8 + 1.2, 0.01 * 1.2);
  EXPECT_NEAR(board.pitch_m, 2e-3, 1e-12) << "the root of the median area";
  EXPECT_NEAR(board.drawn_gap_m, 0.1e-3, 1e-12);
  EXPECT_TRUE((board.extent_m * 1e3).isApprox(Vector2d(15.25, 5.1), 1e-3));
}

TEST(MicrodropBoard, TransformsOfAllGroupsAct) {
  const BoardFile board = read_board_file(kBoards + "microdrop_example.svg", {});
  EXPECT_TRUE(is_at_mm(of(board, 10).centroid - of(board, 1).centroid, 0, -2.1)) << "translate(0,21), y down";
  EXPECT_TRUE(is_at_mm(of(board, 4).centroid - of(board, 0).centroid, 8.4, 0));
  const auto reservoir = bounding_box(of(board, 20).outline), last = bounding_box(of(board, 4).outline);
  EXPECT_NEAR(reservoir.min().x() - last.max().x(), 0.1e-3, 1e-12)
      << "rotate(90) laid its foot beside the last pad";
  EXPECT_NEAR(reservoir.sizes().y(), 2e-3, 1e-12);
  EXPECT_NEAR(reservoir.sizes().x(), 4.75e-3, 4e-6) << "a thousandth of the curve's 40 units";
}

TEST(MicrodropBoard, PassesOverWhatIsNoElectrodeAndReadsAnyNamespacePrefix) {
  const std::string text =
      "<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd'>\n"
      "<x:svg xmlns:x='http://www.w3.org/2000/svg'><x:metadata><dmf:scale> 4 </dmf:scale></x:metadata>"
      "<x:defs><x:path data-channels='9' d='M 0 0'/></x:defs><x:path d='M 0,0 h 5'/>"
      "<x:path data-channels=' 7 ' d='M0 0h1v1h-1z'/></x:svg>";
  const BoardFile board = parse_board_file(text, "board.svg", {});
  ASSERT_EQ(board.electrodes.size(), 1u);
  EXPECT_NEAR(area_mm2(board, 7), 4, 1e-12);
}

TEST(MicrodropBoard, WithoutAScaleTheSceneSaysWhatAUnitIs) {
  const std::string text = svg(pad("M0 0H1V1H0Z"), "");
  EXPECT_TRUE(holds(refused_svg(text), "board.svg: no <scale> in its <metadata>, allowed: with `file_unit`"));
  BoardFileOptions options;
  options.unit_m = 3e-3;
  EXPECT_NEAR(area_mm2(parse_board_file(text, "board.svg", options), 1), 9, 1e-12);
  EXPECT_TRUE(holds(refusal([&] { parse_board_file(svg(pad("M0 0H1V1H0Z")), "board.svg", options); }),
                    "has a <scale>, and `file_unit` is given too"));
}

TEST(BoardFile, PadsThatAreDrawnTouchingHaveTheGapAndNoNeighboursAcrossCorners) {
  const BoardFile board = read_board_file(kBoards + "purpledrop_example.json", {});
  const Layout layout(electrodes_of(board, 0.25e-3, 2), 2);
  const auto neighbours = [&](std::uint32_t channel) {
    return layout.electrodes()[layout.index_of(channel)].neighbours;
  };
  EXPECT_EQ(neighbours(21), (std::vector<std::uint32_t>{10, 20, 22, 30}));
  EXPECT_EQ(neighbours(40), (std::vector<std::uint32_t>{24, 41}));
  EXPECT_EQ(neighbours(50), (std::vector<std::uint32_t>{31, 51}));
  // Nine tenths of the gap of 2 between pads whose pitch is 10.
  EXPECT_NEAR(area(layout.electrodes()[layout.index_of(21)].outline), 8.2 * 8.2, 1e-9);
}

TEST(BoardFile, PadsThatAreDrawnFurtherApartThanTheGapStayAsTheyAre) {
  const BoardFile board = read_board_file(kBoards + "microdrop_example.svg", {});
  const auto electrodes = electrodes_of(board, 0.1e-3, 1.05);
  EXPECT_NEAR(area(electrodes[0].outline), 400, 1e-9);
  EXPECT_EQ(Layout(electrodes, 1.05).electrodes()[1].neighbours, (std::vector<std::uint32_t>{0, 2, 10}));
}

TEST(BoardFile, TeethMayComeOffButAPadTooNarrowForTheGapIsRefused) {
  const std::string two = peripheral(electrode("[[0, 0], [10, 0], [10, 0.3], [0, 0.3]]") + "," +
                                     electrode("[[0, 0.3], [10, 0.3], [10, 10], [0, 10]]", 2));
  const BoardFile board = parse_board_file(two, "board.json", {});
  EXPECT_TRUE(holds(refusal([&] { electrodes_of(board, 1e-3, 1); }),
                    "channel 1: too narrow to be drawn in by 0.45 r_c"));
  EXPECT_EQ(electrodes_of(board, 1e-3, 0.3).size(), 2u);
}

TEST(BoardFile, LeaveOutPassesOverChannels) {
  BoardFileOptions options;
  options.leave_out = {1};
  const std::string text = svg(pad("M0 0H1V1H0Z") + pad("M5 0H6V1H5Z") + pad("M9 0H10V1H9Z", 2));
  EXPECT_EQ(parse_board_file(text, "board.svg", options).electrodes.size(), 1u);
  options.leave_out = {3};
  EXPECT_TRUE(
      holds(refusal([&] { parse_board_file(text, "board.svg", options); }), "leave_out: channel 3, allowed"));
}

TEST(BadBoard, ChannelsGivenTwiceAreRefusedWithBothPlaces) {
  EXPECT_TRUE(holds(refused_svg(svg(pad("M0 0H1V1H0Z") + "\n" + pad("M5 0H6V1H5Z"))),
                    "board.svg: line 4: path: channel 1 given twice, first at line 3: path, allowed: one"));
  EXPECT_TRUE(
      holds(refused_json(json("\"grids\": [{\"origin\": [0, 0], \"pitch\": 1, \"pins\": [[4, null, 4]]}]")),
            "layout.grids[0].pins[0][2]: channel 4 given twice, first at layout.grids[0].pins[0][0]"));
}

TEST(BadBoard, OutlinesThatAreNoneAreRefused) {
  const std::vector<std::pair<std::string, std::string>> paths{
      {"M0 0H1V1H0", "d: an open path, allowed: one that ends with `z` or comes back"},
      {"M0 0L2 2L2 0L0 2Z", "not a simple polygon"},
      {"M0 0H1V1H0ZM3 0H4V1H3Z", "several outlines in one path"},
      {"M0 0H1V1H0ZH4", "goes on after `z`"},
      {"M0 0H1Z", "2 corners, allowed: 3 or more"},
      {"M0 0H1H2Z", "not a simple polygon"},
      {"M0 0H1V1H0Z 5 5", "allowed: one of the commands"},
      {"", "nothing in it"},
      {"H1V1", "allowed: `M` as the first command"},
      {"M0 0 X 3", "`X 3` at character 6, allowed: one of the commands"},
      {"M0 0 H nan V1Z", "allowed: a finite number"},
      {"M0 0 H 1e999 V1Z", "allowed: a finite number"},
      {"M0 0 H 1e30 V1Z", "allowed: coordinates from -1000000 to 1000000"},
      {"M0 0 C 1e308 1e308 -1e308 1e308 1 1Z", "allowed: coordinates"},
      {"M0 0 A 1 1 0 2 0 1 1 Z", "allowed: a flag, 0 or 1"},
  };
  for (const auto& [data, expected] : paths)
    EXPECT_TRUE(holds(refused_svg(svg(pad(data))), expected)) << data;
  EXPECT_TRUE(holds(refused_json(peripheral(electrode("[[0, 0], [2, 2], [2, 0], [0, 2]]"))),
                    "layout.peripherals[0].electrodes[0]: channel 1: not a simple polygon"));
  EXPECT_TRUE(holds(refused_json(peripheral(electrode("[[0, 0], [1, 1], [0, 0]]"))),
                    "2 corners, allowed: 3 or more"));
  EXPECT_TRUE(holds(refused_json(peripheral(electrode("[[0, 0], [1, 1], [2, 2]]"))), "not a simple polygon"));
}

TEST(BadBoard, OverlappingElectrodesAreRefusedTouchingOnesAreNot) {
  EXPECT_TRUE(holds(refused_svg(svg(pad("M0 0H2V2H0Z") + pad("M1 1H3V3H1Z", 2))),
                    "channel 2 overlaps channel 1 (line 3: path), allowed: outlines that touch"));
  EXPECT_TRUE(
      holds(refused_svg(svg(pad("M0 0H9V9H0Z") + pad("M1 1H3V3H1Z", 2))), "channel 2 overlaps channel 1"));
  EXPECT_EQ(parse_board_file(svg(pad("M0 0H2V2H0Z") + pad("M2 0H4V2H2Z", 2)), "b.svg", {}).electrodes.size(),
            2u);
}

TEST(BadBoard, OutlinesThatCrossEverywhereAreRefusedInTime) {
  // Two combs of 240 teeth, one lying on the other: 240^2 squares in common.
  std::string upright = "M-5 -5", lying = "M-5 -5";
  for (int tooth = 0; tooth < 240; ++tooth) {
    const std::string near = std::to_string(4 * tooth), far = std::to_string(4 * tooth + 2);
    upright += "L" + near + " 0 " + near + " 999 " + far + " 999 " + far + " 0";
    lying += "L0 " + near + " 999 " + near + " 999 " + far + " 0 " + far;
  }
  EXPECT_TRUE(holds(refused_svg(svg(pad(upright + "L960 -5z") + pad(lying + "L-5 960z", 2))),
                    "channel 2 overlaps channel 1"));
}

TEST(BadBoard, AScaleThatIsNoneIsRefused) {
  for (const char* scale : {"0", "-1", "nan", "inf", "1e300", "", "0.1 mm", "1,5"}) {
    EXPECT_TRUE(holds(refused_svg(svg(pad("M0 0H1V1H0Z"),
                                      "<metadata><scale>" + std::string(scale) + "</scale></metadata>")),
                      "line 2: scale: "))
        << scale;
  }
  EXPECT_TRUE(
      holds(refused_svg(svg(pad("M0 0H1V1H0Z"), "<metadata><scale>1</scale><scale>2</scale></metadata>")),
            "given twice"));
  for (const char* pitch : {"0", "-2.5", "\"2.5\"", "[2.5]", "1e30"}) {
    EXPECT_TRUE(holds(refused_json(json("\"grids\": [{\"origin\": [0, 0], \"pins\": [[1]], \"pitch\": " +
                                        std::string(pitch) + "}]")),
                      "layout.grids[0].pitch: "))
        << pitch;
  }
}

TEST(BadBoard, ElementsAndChannelsThatMeanSomethingElseAreRefusedByName) {
  const std::vector<std::pair<std::string, std::string>> elements{
      {"<circle data-channels='1' r='3'/>", "circle: has channels, allowed: path, polygon or rect"},
      {"<polyline id='p' data-channels='1' points='0,0 1,0 1,1'/>", "polyline `p`: has channels"},
      {"<rect data-channels='1' width='1' height='1' rx='0.1'/>", "rounded corners"},
      {"<rect data-channels='1' width='0' height='1'/>", "width 0, allowed: a number above 0"},
      {"<rect data-channels='1' width='10mm' height='1'/>", "width 10mm, allowed"},
      {"<path data-channels='1,2' d='M0 0H1V1H0Z'/>",
       "data-channels 1,2, allowed: one channel from 0 to 1000000"},
      {"<path data-channels='-1' d='M0 0H1V1H0Z'/>", "data-channels -1, allowed"},
      {"<path data-channels='99999999999' d='M0 0H1V1H0Z'/>", "data-channels 99999999999, allowed"},
      {"<path data-channels='' d='M0 0H1V1H0Z'/>", "data-channels , allowed"},
      {"<path data-channels='1'/>", "d: nothing in it"},
      {"<svg x='5'>" + pad("M0 0H1V1H0Z") + "</svg>", "a drawing in the drawing"},
      {"<g style='transform:scale(2)'>" + pad("M0 0H1V1H0Z") + "</g>", "a transform in its style"},
      {"<g transform='scale(1e9)'>" + pad("M0 0H1V1H0Z") + "</g>", "after all transforms, allowed"},
      {"<g transform='spin(3)'>" + pad("M0 0H1V1H0Z") + "</g>", "transform: "},
      {"<g transform='scale(0)'>" + pad("M0 0H1V1H0Z") + "</g>", "not a simple polygon"},
      {"", "no electrodes, allowed: one or more path, polygon or rect with data-channels"},
  };
  for (const auto& [element, expected] : elements)
    EXPECT_TRUE(holds(refused_svg(svg(element)), expected)) << element;
}

TEST(BadBoard, ABrokenBoardDefinitionIsRefusedWithItsPlace) {
  const std::string grid = "\"origin\": [0, 0], \"pitch\": 1, \"pins\": ";
  const auto pins = [&](const std::string& rows) { return json("\"grids\": [{" + grid + rows + "}]"); };
  const std::vector<std::pair<std::string, std::string>> texts{
      {"", "is not JSON"},
      {"{", "is not JSON: [json.exception.parse_error.101] parse error at line 1, column 2"},
      {"[]", "board.json: a list of 0, allowed: an object"},
      {"{}", "layout: missing, allowed: an object with `grids`"},
      {"{\"layout\": 5}", "layout: 5, allowed: an object"},
      {json(""), "no electrodes, allowed: one or more pins"},
      {pins("[[null, -1]]"), "no electrodes"},
      {pins("[[-2]]"),
       "layout.grids[0].pins[0][0]: -2, allowed: a pin from 0 to 1000000, or null or -1 for a hole"},
      {pins("[[1.5]]"), "pins[0][0]: 1.5, allowed"},
      {pins("[[\"1\"]]"), "pins[0][0]: \"1\", allowed"},
      {pins("[[1e300]]"), "pins[0][0]: 1e+300, allowed"},
      {pins("[1]"), "pins[0]: 1, allowed: a list of pins"},
      {pins("[[NaN]]"), "is not JSON"},
      {pins("[[1e999]]"), "is not JSON"},
      {json("\"grids\": [{" + grid + "null}]"), "layout.grids[0]: origin, pitch or pins missing"},
      {json("\"grids\": {}"), "layout.grids: an object, allowed: a list"},
      {json("\"grids\": [3]"), "layout.grids[0]: 3, allowed: an object"},
      {json("\"peripherals\": [{\"electrodes\": []}]"), "layout.peripherals[0].origin: missing"},
      {peripheral("{\"pin\": 1}"), "electrodes[0].polygon: missing"},
      {peripheral("{\"polygon\": []}"), "electrodes[0].pin: missing"},
      {peripheral("7"), "electrodes[0]: 7, allowed: an object"},
      {peripheral(electrode("[[0, 0], [1, 0], [1]]")),
       "electrodes[0].polygon[2]: a list of 1, allowed: [x, y]"},
      {peripheral(electrode("[[0, 0], [1, 0], [1, 1e30]]")), "polygon[2]: 1e+30, allowed: a number from"},
      {peripheral(electrode("[[0, 0], [1, 0], [1, 1]]"), "\"rotation\": \"90\", \"origin\": [0, 0]"),
       "rotation: \"90\""},
  };
  for (const auto& [text, expected] : texts) EXPECT_TRUE(holds(refused_json(text), expected)) << text;
}

TEST(BadBoard, BrokenXmlIsRefusedWithItsLine) {
  EXPECT_TRUE(holds(refused_svg("<svg>\n<g>\n</svg>"), "is not XML (XML_ERROR_MISMATCHED_ELEMENT)"));
  EXPECT_TRUE(holds(refused_svg(""), "is not XML"));
  EXPECT_TRUE(holds(refused_svg("nothing"), "is not XML"));
  EXPECT_TRUE(holds(refused_svg("<html/>"), "html: allowed: svg as the outermost element"));
}

TEST(BadBoard, EntitiesAreNotExpandedAndNothingIsLoadedFromElsewhere) {
  std::string laughs = "<!DOCTYPE svg [<!ENTITY a \"ha\">";
  for (char name = 'b'; name < 'l'; ++name) {
    laughs += std::string("<!ENTITY ") + name + " \"";
    for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(name - 1) + ";";
    laughs += "\">";
  }
  EXPECT_TRUE(holds(refused_svg(laughs + "]>" + svg("<path data-channels='&k;' d='M0 0H1V1H0Z'/>")),
                    "line 1: declares an entity, allowed: a drawing without <!ENTITY"));
  EXPECT_TRUE(holds(refused_svg("<!DOCTYPE svg [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>" + svg("&x;")),
                    "declares an entity"));
  EXPECT_TRUE(holds(refused_svg(svg("<path data-channels='&amp;k;' d='M0 0H1V1H0Z'/>")),
                    "data-channels &k;, allowed"));
}

TEST(BadBoard, NestingHasABottom) {
  std::string groups, ends;
  for (int i = 0; i < 100000; ++i) {
    groups += "<g>";
    ends += "</g>";
  }
  EXPECT_TRUE(holds(refused_svg(svg(groups + ends)), "nested too deep, allowed: 100 elements"));
  const std::string open(2000000, '['), close(2000000, ']');
  EXPECT_TRUE(holds(refused_json(open + close), "nested too deep, allowed: 32 levels"));
  EXPECT_TRUE(holds(refused_json(open), "is not JSON"));
}

TEST(BadBoard, MoreThanABoardHasIsRefusedAndFaultsAreToldInPart) {
  std::string many = "M0 0";
  for (int i = 0; i < 1100; ++i) many += " l1 1";
  EXPECT_TRUE(holds(refused_svg(svg(pad(many + "z"))), "too many corners, allowed: 1000 an electrode"));
  std::string pads;
  for (int i = 0; i < 501; ++i) pads += pad("M" + std::to_string(2 * i) + " 0h1v1h-1z", i);
  EXPECT_TRUE(holds(refused_svg(svg(pads)), "one electrode too many, allowed: 500"));
  std::string round;
  for (int i = 0; i < 60; ++i) {
    round += "<path data-channels='" + std::to_string(i) + "' d='M" + std::to_string(10 * i) + " 0";
    for (int k = 1; k < 900; ++k) round += " l.001 " + std::to_string(0.001 * k);
    round += "z'/>";
  }
  EXPECT_TRUE(holds(refused_svg(svg(round)), "54000 corners, allowed: 50000 in all"));
  std::string open;
  for (int i = 0; i < 500; ++i) open += pad("M0 0H1", i);
  EXPECT_LT(refused_svg(svg(open)).size(), 5000u);
}

TEST(BadBoard, DigitsWithoutEndAreReadOnceAndRefused) {
  const std::string digits(3000000, '7');
  EXPECT_TRUE(holds(refused_svg(svg(pad("M0 0H" + digits + "V1H0Z"))), "allowed: a finite number"));
  EXPECT_TRUE(holds(refused_json(json("\"grid\": [[" + digits + "]]")), "is not JSON"));
}

TEST(BadBoard, AFileThatIsTooLargeOrNoFileIsRefusedBeforeItIsRead) {
  const std::string folder = testing::TempDir() + "dmf_board_files/";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder + "folder.json");
  const auto refused = [](const std::string& file) { return refusal([&] { read_board_file(file, {}); }); };
  std::ofstream(folder + "large.svg") << "<svg/>";
  std::filesystem::resize_file(folder + "large.svg", std::uintmax_t{1} << 33);  // takes no room on disk
  EXPECT_TRUE(holds(refused(folder + "large.svg"), "large.svg: 8589934592 bytes, allowed: up to 4194304"));
  EXPECT_TRUE(holds(refused(folder + "folder.json"), "folder.json: is no file"));
  EXPECT_TRUE(holds(refused(folder + "none.svg"), "none.svg: is no file"));
  ASSERT_EQ(mkfifo((folder + "pipe.svg").c_str(), 0600), 0);
  EXPECT_TRUE(holds(refused(folder + "pipe.svg"), "pipe.svg: is no file"));
  std::ofstream(folder + "board.txt") << "{}";
  EXPECT_TRUE(
      holds(refused(folder + "board.txt"), "allowed: a PurpleDrop board definition (.json) or a MicroDrop"));
}

/// Loads, or is refused with a text.
void survives(const std::string& text, const std::string& name) {
  try {
    for (const Electrode& electrode : parse_board_file(text, name, {}).electrodes)
      EXPECT_EQ(polygon_fault(electrode.outline), "");
  } catch (const InvalidInput& refused) {
    EXPECT_NE(std::string(refused.what()).find(name), std::string::npos);
  }
}

TEST(BadBoard, CutOffOrFlippedBytesLoadOrAreRefused) {
  for (const char* name : {"purpledrop_example.json", "microdrop_example.svg"}) {
    const std::string text = text_of(kBoards + name);
    ASSERT_GT(text.size(), 1000u);
    for (std::size_t length = 0; length < text.size(); length += 7) survives(text.substr(0, length), name);
    std::uint64_t random = 1;  // Knuth's linear congruences: any will do
    for (int round = 0; round < 1500; ++round) {
      std::string changed = text;
      for (int i = 0; i <= round % 3; ++i) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        changed[(random >> 33) % text.size()] = static_cast<char>(random >> 24);
      }
      survives(changed, name);
    }
  }
}

}  // namespace
}  // namespace dmf::chip
