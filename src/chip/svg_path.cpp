#include "chip/svg_path.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <vector>

#include "chip/board_drawing.h"
#include "engine/parameters.h"
#include "yaml/quantity.h"
#include "yaml/units.h"

namespace dmf::chip {

namespace {

using Eigen::Affine2d;
using Eigen::Vector2d;

/// How far a chord may stray from its curve, as a fraction of the curve's size.
constexpr double kFlatness = 1e-3;

/// Numbers and letters of an SVG attribute, one after the other.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text), left_(text) {}

  bool at_end() {
    skip();
    return left_.empty();
  }
  char peek() {
    skip();
    return left_.empty() ? '\0' : left_.front();
  }
  char take() {
    const char letter = peek();
    if (!left_.empty()) left_.remove_prefix(1);
    return letter;
  }
  bool at_number() {
    const char next = peek();
    return std::isdigit(static_cast<unsigned char>(next)) || next == '-' || next == '+' || next == '.';
  }
  double number() {
    skip();
    const std::optional<double> value = at_number() ? take_number(left_) : std::nullopt;
    if (!value) refuse("a finite number");
    return *value;
  }
  /// The flags of an arc may stand without anything between them and what follows.
  bool flag() {
    const char next = take();
    if (next != '0' && next != '1') refuse("a flag, 0 or 1");
    return next == '1';
  }
  std::string_view word() {
    skip();
    std::size_t length = 0;
    while (length < left_.size() && std::isalpha(static_cast<unsigned char>(left_[length]))) ++length;
    const std::string_view word = left_.substr(0, length);
    left_.remove_prefix(length);
    return word;
  }
  [[noreturn]] void refuse(const std::string& allowed) const {
    constexpr std::size_t kShown = 20;
    const std::string here = left_.empty() ? "its end" : fmt::format("`{}`", left_.substr(0, kShown));
    throw engine::InvalidInput(
        fmt::format("{} at character {}, allowed: {}", here, text_.size() - left_.size() + 1, allowed));
  }

 private:
  void skip() {
    while (!left_.empty() && (std::isspace(static_cast<unsigned char>(left_.front())) || left_[0] == ','))
      left_.remove_prefix(1);
  }

  std::string_view text_, left_;
};

void check_size(const Vector2d& point) {
  if ((point.array().abs() <= kMaxCoordinate).all()) return;
  throw engine::InvalidInput(fmt::format("the point ({:.6g}, {:.6g}), allowed: coordinates from {} to {}",
                                         point.x(), point.y(), -kMaxCoordinate, kMaxCoordinate));
}

/// Turns commands into corners. Holds what SVG calls the current point and the last control point.
class Outline {
 public:
  void move(const Vector2d& to) {
    if (started_) {
      throw engine::InvalidInput("several outlines in one path, allowed: one closed outline an electrode");
    }
    started_ = true;
    add(to);
    first_ = to;
  }
  void line(const Vector2d& to) { add(to); }

  /// Chords of a Bezier curve of degree 3. Their number follows from Wang's bound on the distance of chord
  /// and curve, n^2 = 3/4 max |second difference of the control points| / tolerance (Wang 1984).
  void cubic(const Vector2d& a, const Vector2d& b, const Vector2d& to) {
    const Vector2d from = point_;
    const double size = (a - from).norm() + (b - a).norm() + (to - b).norm();
    const double bend = std::max((from - 2 * a + b).norm(), (a - 2 * b + to).norm());
    const int chords =
        size > 0 ? std::max(1, static_cast<int>(std::ceil(std::sqrt(0.75 * bend / (kFlatness * size))))) : 1;
    for (int i = 1; i < chords; ++i) {
      const double t = static_cast<double>(i) / chords, s = 1 - t;
      add(s * s * s * from + 3 * s * s * t * a + 3 * s * t * t * b + t * t * t * to);
    }
    add(to);
  }
  void quadratic(const Vector2d& control, const Vector2d& to) {
    cubic(point_ + 2.0 / 3 * (control - point_), to + 2.0 / 3 * (control - to), to);
  }

  /// SVG 1.1, appendix F.6: from end points to centre, radii that are too small are grown.
  void arc(Vector2d radii, double tilt, bool large, bool sweep, const Vector2d& to) {
    radii = radii.cwiseAbs();
    const Vector2d from = point_;
    if (from == to) return;
    if (radii.minCoeff() == 0) return line(to);
    const Eigen::Rotation2Dd turn(tilt);
    const Vector2d half = turn.inverse() * (0.5 * (from - to));  // (F.6.5.1)
    const double reach = half.cwiseQuotient(radii).norm();       // (F.6.6.2)
    if (reach > 1) radii *= reach;                               // (F.6.6.3)
    const Vector2d unit = half.cwiseQuotient(radii);
    const double away = std::sqrt(std::max(0.0, 1 / unit.squaredNorm() - 1)) * (large == sweep ? -1 : 1);
    const Vector2d centre_unit(away * unit.y(), -away * unit.x());  // (F.6.5.2), in units of the radii
    const Vector2d centre = turn * centre_unit.cwiseProduct(radii) + 0.5 * (from + to);
    const Vector2d start = unit - centre_unit, end = -unit - centre_unit;
    const double first = std::atan2(start.y(), start.x());
    double angle = std::atan2(end.y(), end.x()) - first;
    if (sweep && angle < 0) angle += 2 * M_PI;
    if (!sweep && angle > 0) angle -= 2 * M_PI;
    if (!std::isfinite(angle)) return line(to);  // the radii are beyond all measure
    const int chords = static_cast<int>(std::ceil(std::abs(angle) / (2 * std::acos(1 - kFlatness))));
    for (int i = 1; i < chords; ++i) {
      const double at = first + angle * i / chords;
      add(turn * Vector2d(std::cos(at), std::sin(at)).cwiseProduct(radii) + centre);
    }
    add(to);
  }

  void close() {
    closed_ = true;
    point_ = first_;
  }

  const Vector2d& point() const { return point_; }
  bool closed() const { return closed_; }
  bool started() const { return started_; }

  Polygon corners() const {
    Polygon corners;
    for (const Vector2d& corner : corners_) {
      if (corners.empty() || corner != corners.back()) corners.push_back(corner);
    }
    const bool returns = corners.size() > 1 && corners.front() == corners.back();
    if (!closed_ && !returns) {
      throw engine::InvalidInput(
          "an open path, allowed: one that ends with `z` or comes back to where it started");
    }
    if (returns) corners.pop_back();
    return corners;
  }

 private:
  void add(const Vector2d& corner) {
    if (closed_) {
      throw engine::InvalidInput("goes on after `z`, allowed: one closed outline an electrode");
    }
    if (corners_.size() > kMaxCorners) {
      throw engine::InvalidInput(fmt::format("too many corners, allowed: {} an electrode", kMaxCorners));
    }
    check_size(corner);
    corners_.push_back(corner);
    point_ = corner;
  }

  Polygon corners_;
  Vector2d point_ = Vector2d::Zero(), first_ = Vector2d::Zero();
  bool started_ = false, closed_ = false;
};

/// Reads the commands one by one. A letter in lower case counts from the current point.
class PathReader {
 public:
  explicit PathReader(std::string_view text) : text_(text) {}

  Polygon read() {
    if (text_.at_end())
      throw engine::InvalidInput("nothing in it, allowed: path data such as `M 0,0 H 1 V 1 Z`");
    while (!text_.at_end()) {
      if (text_.at_number()) {
        if (!command_ || std::toupper(command_) == 'Z') text_.refuse("one of the commands MLHVCSQTAZ");
        // Numbers without a letter repeat the last one; after a move they are lines.
        if (command_ == 'M') command_ = 'L';
        if (command_ == 'm') command_ = 'l';
      } else {
        if (std::string_view("MLHVCSQTAZ").find(static_cast<char>(std::toupper(text_.peek()))) ==
            std::string_view::npos) {
          text_.refuse("one of the commands MLHVCSQTAZ");
        }
        if (!outline_.started() && std::toupper(text_.peek()) != 'M')
          text_.refuse("`M` as the first command");
        command_ = text_.take();
      }
      obey();
    }
    return outline_.corners();
  }

 private:
  Vector2d base() const { return std::islower(command_) ? outline_.point() : Vector2d::Zero(); }
  Vector2d pair() {
    const Vector2d from = base();
    const double x = text_.number();
    const Vector2d point = from + Vector2d(x, text_.number());
    check_size(point);
    return point;
  }
  /// The last control point mirrored at the current point, if the last command had one.
  Vector2d smooth(char of) const {
    const bool follows = last_curve_ == of;
    return follows ? Vector2d(2 * outline_.point() - control_) : outline_.point();
  }

  void obey() {
    const char command = static_cast<char>(std::toupper(command_));
    char curve = '\0';
    switch (command) {
      case 'M':
        outline_.move(pair());
        break;
      case 'L':
        outline_.line(pair());
        break;
      case 'H': {
        const double from = base().x();
        outline_.line({from + text_.number(), outline_.point().y()});
        break;
      }
      case 'V': {
        const double from = base().y();
        outline_.line({outline_.point().x(), from + text_.number()});
        break;
      }
      case 'C':
      case 'S': {
        const Vector2d first = command == 'C' ? pair() : smooth('C');
        control_ = pair();
        outline_.cubic(first, control_, pair());
        curve = 'C';
        break;
      }
      case 'Q':
      case 'T': {
        control_ = command == 'Q' ? pair() : smooth('Q');
        outline_.quadratic(control_, pair());
        curve = 'Q';
        break;
      }
      case 'A': {
        const double rx = text_.number(), ry = text_.number(), tilt = text_.number() * degree;
        const bool large = text_.flag(), sweep = text_.flag();
        outline_.arc({rx, ry}, tilt, large, sweep, pair());
        break;
      }
      default:
        outline_.close();
    }
    last_curve_ = curve;
  }

  Scanner text_;
  Outline outline_;
  char command_ = '\0';
  char last_curve_ = '\0';  ///< 'C' or 'Q': the last command was such a curve
  Vector2d control_ = Vector2d::Zero();
};

Affine2d affine(double a, double b, double c, double d, double e, double f) {
  Affine2d transform;
  transform.matrix() << a, c, e, b, d, f, 0, 0, 1;
  return transform;
}

}  // namespace

Polygon closed_path(std::string_view path_data) { return PathReader(path_data).read(); }

Polygon polygon_points(std::string_view points) {
  Scanner scanner(points);
  Outline outline;
  while (!scanner.at_end()) {
    const double x = scanner.number();
    const Vector2d corner(x, scanner.number());
    outline.started() ? outline.line(corner) : outline.move(corner);
  }
  outline.close();
  return outline.corners();
}

Affine2d svg_transform(std::string_view transform) {
  Scanner scanner(transform);
  Affine2d product = Affine2d::Identity();
  while (!scanner.at_end()) {
    const std::string_view name = scanner.word();
    std::vector<double> n;
    if (scanner.peek() == '(') scanner.take();
    while (n.size() < 6 && scanner.at_number()) n.push_back(scanner.number());
    const bool known = (name == "matrix" && n.size() == 6) ||
                       (name == "translate" && (n.size() == 1 || n.size() == 2)) ||
                       (name == "scale" && (n.size() == 1 || n.size() == 2)) ||
                       (name == "rotate" && (n.size() == 1 || n.size() == 3)) ||
                       ((name == "skewX" || name == "skewY") && n.size() == 1);
    if (!known || scanner.peek() != ')') {
      scanner.refuse(
          "matrix(a b c d e f), translate(x y), scale(x y), rotate(angle x y), skewX(angle), skewY(angle)");
    }
    scanner.take();
    if (name == "matrix") product = product * affine(n[0], n[1], n[2], n[3], n[4], n[5]);
    if (name == "translate") product = product * affine(1, 0, 0, 1, n[0], n.size() > 1 ? n[1] : 0);
    if (name == "scale") product = product * affine(n[0], 0, 0, n.size() > 1 ? n[1] : n[0], 0, 0);
    if (name == "skewX") product = product * affine(1, 0, std::tan(n[0] * degree), 1, 0, 0);
    if (name == "skewY") product = product * affine(1, std::tan(n[0] * degree), 0, 1, 0, 0);
    if (name == "rotate") {
      const Vector2d about = n.size() > 1 ? Vector2d(n[1], n[2]) : Vector2d::Zero();
      product = product * Eigen::Translation2d(about) * Eigen::Rotation2Dd(n[0] * degree) *
                Eigen::Translation2d(-about);
    }
  }
  return product;
}

}  // namespace dmf::chip
