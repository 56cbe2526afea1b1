// SPDX-License-Identifier: Apache-2.0
#include "optics/sdf.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>

namespace lorgnette {
namespace {

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::optional<double> Number(std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  while (end && (*end == ' ' || *end == '\t')) ++end;
  if (copy.empty() || end == copy.c_str() || *end != '\0' || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

// Node (row, col) of the file in our axes: x toward the wearer's right, y up.
struct Layout {
  int rows, cols;
  double width, height;
  SdfOptions options;

  double PitchX() const { return width / (cols - 1); }
  double PitchY() const { return height / (rows - 1); }
  // Index into our grid, x ascending and y ascending.
  int Column(int file) const {
    // The viewer's right is the wearer's left, -x.
    return options.columns_run_to_viewers_right ? cols - 1 - file : file;
  }
  int Row(int file) const { return options.first_row_is_top ? rows - 1 - file : file; }
  double Sign() const { return options.sag_toward_eye ? 1 : -1; }
};

class Parser {
 public:
  Parser(const std::string& text, const std::string& name, const SdfOptions& options)
      : lines_(Split(text, '\n')), name_(name), options_(options) {}

  Result<std::vector<SdfSurface>> All() {
    std::vector<SdfSurface> surfaces;
    while (at_ < lines_.size()) {
      const std::string_view line = Line();
      ++at_;
      if (line.starts_with("SURFMT=")) {
        LG_ASSIGN(SdfSurface surface, One(line.substr(7)));
        surfaces.push_back(std::move(surface));
      }
    }
    if (surfaces.empty()) return UsageError(name_ + ": no SURFMT line, want an SDF surface");
    return surfaces;
  }

 private:
  std::string_view Line() const {
    std::string_view line = lines_[at_];
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }
  tl::unexpected<Error> Bad(const std::string& what) const {
    return UsageError(fmt::format("{}:{}: {}", name_, at_, what));
  }

  Result<SdfSurface> One(std::string_view header) {
    const auto fields = Split(header, ';');
    if (fields.size() < 7) return Bad("want SURFMT=1;eye;face;rows;cols;width;height");
    if (fields[0] != "1") {
      return Bad(fmt::format("SURFMT: got format {}, want 1", fields[0]));
    }
    SdfSurface out;
    if (fields[1] != "R" && fields[1] != "L") {
      return Bad(fmt::format("SURFMT: got eye {}, want R or L", fields[1]));
    }
    if (fields[2] != "F" && fields[2] != "B") {
      return Bad(fmt::format("SURFMT: got face {}, want F or B", fields[2]));
    }
    out.eye = fields[1] == "R" ? Eye::kRight : Eye::kLeft;
    out.face = fields[2] == "F" ? SdfFace::kFront : SdfFace::kBack;
    double numbers[4];
    for (int i = 0; i < 4; ++i) {
      const auto number = Number(fields[3 + i]);
      if (!number) return Bad(fmt::format("SURFMT: got {}, want a number", fields[3 + i]));
      numbers[i] = *number;
    }
    for (int i = 0; i < 2; ++i) {
      if (!(numbers[i] >= 4 && numbers[i] <= kMaxSdfNodes &&
            numbers[i] == std::floor(numbers[i]))) {
        return Bad(fmt::format("SURFMT: got {} nodes, want a whole number 4..{}", numbers[i],
                               kMaxSdfNodes));
      }
      if (!(numbers[2 + i] > 0 && numbers[2 + i] <= 200)) {
        return Bad(fmt::format("SURFMT: got {} mm, want 0..200", numbers[2 + i]));
      }
    }
    const Layout layout{int(numbers[0]), int(numbers[1]), numbers[2], numbers[3], options_};
    Eigen::MatrixXd sag(layout.cols, layout.rows);
    for (int row = 0; row < layout.rows; ++row) {
      LG_RETURN_IF_ERROR(ReadRow(row, layout, sag));
    }
    out.rows = layout.rows;
    out.cols = layout.cols;
    out.width_mm = layout.width;
    out.height_mm = layout.height;
    out.surface = Spline(sag, layout);
    return out;
  }

  Status ReadRow(int row, const Layout& layout, Eigen::MatrixXd& sag) {
    while (at_ < lines_.size() && Line().empty()) ++at_;
    if (at_ >= lines_.size() || !Line().starts_with("ZZ=")) {
      return Bad(fmt::format("got {} rows of sags, want {}", row, layout.rows));
    }
    auto values = Split(Line().substr(3), ';');
    ++at_;
    if (!values.empty() && values.back().empty()) values.pop_back();
    if (int(values.size()) != layout.cols) {
      return Bad(fmt::format("ZZ: got {} sags, want {}", values.size(), layout.cols));
    }
    for (int col = 0; col < layout.cols; ++col) {
      const auto z = Number(values[col]);
      if (!z) return Bad(fmt::format("ZZ: got \"{}\", want a number", values[col]));
      sag(layout.Column(col), layout.Row(row)) = layout.Sign() * *z;
    }
    return {};
  }

  static Surface Spline(const Eigen::MatrixXd& sag, const Layout& layout) {
    const double x0 = -layout.width / 2, y0 = -layout.height / 2;
    const double px = layout.PitchX(), py = layout.PitchY();
    const auto raw = std::make_shared<SplineGrid>(SplineGrid::Through(sag, x0, y0, px, py, 0));
    const double z0 = JetOf(GridSurface{raw}, 0, 0)->z;
    return GridSurface{std::make_shared<SplineGrid>(
        SplineGrid::Through((sag.array() - z0).matrix(), x0, y0, px, py, 0))};
  }

  std::vector<std::string_view> lines_;
  const std::string& name_;
  SdfOptions options_;
  std::size_t at_ = 0;
};

}  // namespace

Result<std::vector<SdfSurface>> ParseSdf(const std::string& text, const std::string& name,
                                         const SdfOptions& options) {
  return Parser(text, name, options).All();
}

Result<std::string> WriteSdf(const Surface& surface, Eye eye, SdfFace face, int rows, int cols,
                             double width_mm, double height_mm, const SdfOptions& options) {
  const Layout layout{rows, cols, width_mm, height_mm, options};
  std::string text =
      fmt::format("SURFMT=1;{};{};{};{};{};{};0\n", eye == Eye::kRight ? "R" : "L",
                  face == SdfFace::kFront ? "F" : "B", rows, cols, width_mm, height_mm);
  for (int row = 0; row < rows; ++row) {
    text += "ZZ=";
    for (int col = 0; col < cols; ++col) {
      const double x = -width_mm / 2 + layout.Column(col) * layout.PitchX();
      const double y = -height_mm / 2 + layout.Row(row) * layout.PitchY();
      const auto jet = surface.Jet(x, y);
      if (!jet) {
        return Failure(
            fmt::format("sdf: the surface ends before ({:.1f}, {:.1f}) mm; possible: a "
                        "smaller grid",
                        x, y));
      }
      text += fmt::format("{}{}", col == 0 ? "" : ";", layout.Sign() * jet->z);
    }
    text += '\n';
  }
  return text;
}

}  // namespace lorgnette
