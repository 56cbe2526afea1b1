// SPDX-License-Identifier: Apache-2.0
#include "apps/svg.h"

#include <fmt/format.h>

namespace lorgnette {
namespace {

constexpr double kArrowLength = 7, kArrowHalfWidth = 2;
constexpr double kRoomForArrows = 26;  // shorter dimensions get their arrows from outside
constexpr double kOutsideTail = 14;

std::string Escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

constexpr const char* kStyle = R"(
  .edge { fill: none; stroke: #111; stroke-width: 1.6 }
  .thin { fill: none; stroke: #333; stroke-width: 0.6 }
  .axis { fill: none; stroke: #a02020; stroke-width: 0.7; stroke-dasharray: 12 3 2 3 }
  .glass { fill: url(#hatch); stroke: none }
  .mark { fill: none; stroke: #7a1f1f; stroke-width: 0.8 }
  .contour { font-size: 8.5px; paint-order: stroke; stroke: white; stroke-width: 2px }
  .arrow { fill: #333; stroke: none }
  text { font-family: "DejaVu Sans", Arial, sans-serif; fill: #111 }
  .label { font-size: 11px }
  .title { font-size: 15px; font-weight: bold }
  .head { font-size: 11px; font-weight: bold }
  .small { font-size: 9.5px; fill: #444 }
)";

}  // namespace

void Svg::Line(const Point& a, const Point& b, const std::string& style) {
  body_ += fmt::format(R"(<line x1="{:.2f}" y1="{:.2f}" x2="{:.2f}" y2="{:.2f}" class="{}"/>)",
                       a.x(), a.y(), b.x(), b.y(), style) +
           '\n';
}

void Svg::Outline(const std::vector<Point>& points, bool closed, const std::string& style) {
  std::string path;
  for (const Point& p : points) {
    path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", p.x(), p.y());
  }
  body_ += fmt::format(R"(<path d="{}{}" class="{}"/>)", path, closed ? "Z" : "", style) + '\n';
}

void Svg::Text(const Point& at, const std::string& text, Anchor anchor, const std::string& style) {
  const char* name = anchor == Anchor::kStart    ? "start"
                     : anchor == Anchor::kMiddle ? "middle"
                                                 : "end";
  body_ += fmt::format(R"(<text x="{:.2f}" y="{:.2f}" text-anchor="{}" class="{}">{}</text>)",
                       at.x(), at.y(), name, style, Escaped(text)) +
           '\n';
}

void Svg::Arrow(const Point& tip, const Point& direction) {
  const Point back = tip - kArrowLength * direction;
  const Point side = kArrowHalfWidth * Point(-direction.y(), direction.x());
  Outline({tip, back + side, back - side}, true, "arrow");
}

void Svg::Dimension(const Point& a, const Point& b, const Point& text_at, const std::string& text,
                    Anchor anchor) {
  const Point along = (b - a).normalized();
  if ((b - a).norm() >= kRoomForArrows) {
    Line(a, b, "thin");
    Arrow(a, -along);
    Arrow(b, along);
  } else {
    Line(a - kOutsideTail * along, b + kOutsideTail * along, "thin");
    Arrow(a, along);
    Arrow(b, -along);
  }
  Text(text_at, text, anchor);
}

void Svg::Leader(const Point& target, const Point& label, const std::string& text, Anchor anchor) {
  Line(target, label, "thin");
  body_ += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="1.6" class="arrow"/>)", target.x(),
                       target.y()) +
           '\n';
  const double gap = anchor == Anchor::kEnd ? -3 : 3;
  Text(label + Point(gap, 4), text, anchor);
}

void Svg::Circle(const Point& centre, double radius, const std::string& style) {
  body_ += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" class="{}"/>)", centre.x(),
                       centre.y(), radius, style) +
           '\n';
}

void Svg::Path(const std::string& data, const std::string& attributes) {
  body_ += fmt::format(R"(<path d="{}" {}/>)", data, attributes) + '\n';
}

void Svg::BeginClip(const Point& centre, double radius) {
  const int id = clips_++;
  body_ += fmt::format(R"(<clipPath id="disc{0}"><circle cx="{1:.2f}" cy="{2:.2f}" r="{3:.2f}"/>)"
                       R"x(</clipPath><g clip-path="url(#disc{0})">)x",
                       id, centre.x(), centre.y(), radius) +
           '\n';
}

std::string Svg::Document() const {
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" )"
                     R"(viewBox="0 0 {0:.0f} {1:.0f}">)"
                     "\n<style>{2}</style>\n"
                     R"(<defs><pattern id="hatch" width="5" height="5" )"
                     R"x(patternUnits="userSpaceOnUse" patternTransform="rotate(45)">)x"
                     R"(<rect width="5" height="5" fill="#eef4fb"/>)"
                     R"(<line x1="0" y1="0" x2="0" y2="5" stroke="#9db6d3" stroke-width="0.8"/>)"
                     "</pattern></defs>\n"
                     R"(<rect width="100%" height="100%" fill="white"/>)"
                     "\n{3}</svg>\n",
                     width_, height_, kStyle, body_);
}

}  // namespace lorgnette
