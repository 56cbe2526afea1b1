// SPDX-License-Identifier: Apache-2.0
// A drawing in SVG: lines, outlines, text and dimensions, in plain technical-drawing style.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lorgnette {

class Svg {
 public:
  using Point = Eigen::Vector2d;  // x to the right, y downwards, SVG units
  enum class Anchor { kStart, kMiddle, kEnd };

  Svg(double width, double height) : width_(width), height_(height) {}

  // Styles are the classes of the sheet that Document() writes: "edge", "thin", "axis", "glass",
  // "mark".
  void Line(const Point& a, const Point& b, const std::string& style);
  void Outline(const std::vector<Point>& points, bool closed, const std::string& style);
  void Text(const Point& at, const std::string& text, Anchor anchor = Anchor::kStart,
            const std::string& style = "label");
  // A dimension between two points of one line, with arrows: between them where there is room,
  // from outside where there is not. The text stands at `text_at`.
  void Dimension(const Point& a, const Point& b, const Point& text_at, const std::string& text,
                 Anchor anchor = Anchor::kMiddle);
  // A thin line from a label to what it names, with a dot at the end.
  void Leader(const Point& target, const Point& label, const std::string& text, Anchor anchor);

  void Circle(const Point& centre, double radius, const std::string& style);
  // SVG path data as it stands, with attributes in place of a style.
  void Path(const std::string& data, const std::string& attributes);
  // What comes between is cut to a disc.
  void BeginClip(const Point& centre, double radius);
  void EndClip() { body_ += "</g>\n"; }

  std::string Document() const;

 private:
  void Arrow(const Point& tip, const Point& direction);
  double width_, height_;
  int clips_ = 0;
  std::string body_;
};

}  // namespace lorgnette
