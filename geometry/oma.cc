// SPDX-License-Identifier: Apache-2.0
#include "geometry/oma.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/units.h"
#include "geometry/closed_curve.h"

namespace lorgnette {
namespace {

constexpr std::size_t kLeastPoints = 8, kMostPoints = 20000;
constexpr double kLeastRadius_mm = 5, kGreatestRadius_mm = 60;
constexpr std::size_t kValuesPerLine = 10;

std::vector<std::string> Split(std::string_view text, char at) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t end = std::min(text.find(at), text.size());
    fields.emplace_back(text.substr(0, end));
    if (end == text.size()) return fields;
    text.remove_prefix(end + 1);
  }
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool ReadNumber(std::string_view text, double& value) {
  text = Trim(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// The other eye's shape: x changes sign.
std::vector<Eigen::Vector2d> Mirror(const std::vector<Eigen::Vector2d>& contour) {
  std::vector<Eigen::Vector2d> mirrored(contour.rbegin(), contour.rend());
  for (Eigen::Vector2d& p : mirrored) p.x() = -p.x();
  return mirrored;
}

// `label=1234;...` lines of ten whole hundredths each.
void AppendHundredths(const char* label, const std::vector<double>& values,
                      std::vector<std::string>& lines) {
  for (std::size_t k = 0; k < values.size(); k += kValuesPerLine) {
    std::string text = fmt::format("{}=", label);
    for (std::size_t j = k; j < std::min(k + kValuesPerLine, values.size()); ++j) {
      text += fmt::format("{}{:04d}", j == k ? "" : ";", std::lround(100 * values[j]));
    }
    lines.push_back(std::move(text));
  }
}

const char* Side(Eye eye) { return eye == Eye::kRight ? "R" : "L"; }

}  // namespace

Result<OmaFile> OmaFile::Parse(std::string_view bytes, const std::string& name) {
  OmaFile file;
  file.name_ = name;
  bool any = false;
  while (!bytes.empty()) {
    const std::size_t length = std::min(bytes.find_first_of("\r\n"), bytes.size());
    std::size_t end = length == bytes.size() ? 0 : 1;
    if (end == 1 && bytes[length] == '\r' && length + 1 < bytes.size() &&
        bytes[length + 1] == '\n') {
      end = 2;
    }
    file.lines_.push_back(
        {std::string(bytes.substr(0, length)), std::string(bytes.substr(length, end))});
    any = any || !LabelOf(file.lines_.back().text).empty();
    bytes.remove_prefix(length + end);
  }
  if (!any) return Failure(name + ": got no LABEL=value line, want an OMA file");
  return file;
}

std::string OmaFile::Text() const {
  std::string text;
  for (const Line& line : lines_) text += line.text + line.end;
  return text;
}

std::string OmaFile::LabelOf(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {};
  // A packet from a serial line begins with FS.
  const std::size_t start = !text.empty() && text[0] == '\x1c' ? 1 : 0;
  return std::string(Trim(std::string_view(text).substr(start, equals - start)));
}

std::optional<std::string> OmaFile::Get(const std::string& label) const {
  for (const Line& line : lines_) {
    if (LabelOf(line.text) == label) {
      return std::string(Trim(std::string_view(line.text).substr(line.text.find('=') + 1)));
    }
  }
  return std::nullopt;
}

Result<OmaPair> OmaFile::Numbers(const std::string& label) const {
  OmaPair pair;
  const auto text = Get(label);
  if (!text) return pair;
  const std::vector<std::string> fields = Split(*text, ';');
  std::optional<double> values[2];
  for (std::size_t k = 0; k < std::min<std::size_t>(2, fields.size()); ++k) {
    const std::string_view field = Trim(fields[k]);
    if (field.empty() || field == "?") continue;
    double value = 0;
    if (!ReadNumber(field, value)) {
      return Failure(name_ + ":" + label + ": got \"" + std::string(field) + "\", want a number");
    }
    values[k] = value;
  }
  pair.right = values[0];
  pair.left = fields.size() == 1 ? values[0] : values[1];
  return pair;
}

void OmaFile::Set(const std::string& label, const std::string& value) {
  for (Line& line : lines_) {
    if (LabelOf(line.text) == label) {
      line.text.replace(line.text.find('=') + 1, std::string::npos, value);
      return;
    }
  }
  const std::string end = lines_.empty() || lines_[0].end.empty() ? "\r\n" : lines_[0].end;
  if (!lines_.empty() && lines_.back().end.empty()) lines_.back().end = end;
  lines_.push_back({label + "=" + value, end});
}

Result<std::vector<double>> OmaFile::Block(std::size_t from, const std::string& label,
                                           std::size_t count) const {
  std::vector<double> values;
  for (std::size_t i = from + 1; i < lines_.size() && values.size() < count; ++i) {
    const std::string at = LabelOf(lines_[i].text);
    if (at == "TRCFMT" || at == "STHKFMT") break;
    if (at != label) continue;
    const std::string_view text = std::string_view(lines_[i].text).substr(label.size() + 1);
    for (const std::string& field : Split(text, ';')) {
      double value = 0;
      if (Trim(field).empty()) continue;
      if (!ReadNumber(field, value)) {
        return Failure(fmt::format("{}:{}: got \"{}\", want a number", name_, label, field));
      }
      values.push_back(value);
    }
  }
  if (values.size() != count) {
    return Failure(
        fmt::format("{}:{}: got {} values, want {}", name_, label, values.size(), count));
  }
  return values;
}

Result<std::vector<OmaTrace>> OmaFile::Traces() const {
  std::vector<OmaTrace> traces;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (LabelOf(lines_[i].text) != "TRCFMT") continue;
    const std::string value = lines_[i].text.substr(lines_[i].text.find('=') + 1);
    const std::vector<std::string> fields = Split(value, ';');
    double format = 0, points = 0;
    if (fields.size() < 4 || !ReadNumber(fields[0], format) || !ReadNumber(fields[1], points)) {
      return Failure(name_ + ":TRCFMT: got \"" + value + "\", want format;points;E|U;R|L;F|P");
    }
    if (format == 0) continue;  // no trace
    if (format != 1) {
      return Failure(
          fmt::format("{}:TRCFMT: got format {:g} (packed or a vendor's own), want 1 (ASCII radii)",
                      name_, format));
    }
    if (points != std::floor(points) || points < double(kLeastPoints) ||
        points > double(kMostPoints)) {
      return Failure(fmt::format("{}:TRCFMT: got {:g} points, want {}..{}", name_, points,
                                 kLeastPoints, kMostPoints));
    }
    const std::size_t count = std::size_t(points);
    LG_ASSIGN(const std::vector<double> radii, Block(i, "R", count));
    std::vector<double> angles;
    if (fields[2] == "U") {
      LG_ASSIGN(angles, Block(i, "A", count));
    }
    OmaTrace trace;
    trace.eye = fields[3] == "L" ? Eye::kLeft : Eye::kRight;
    for (std::size_t k = 0; k < count; ++k) {
      const double radius = radii[k] / 100;
      if (!(radius >= kLeastRadius_mm && radius <= kGreatestRadius_mm)) {
        return Failure(fmt::format("{}:R: got a radius of {:.2f} mm, want {}..{}", name_, radius,
                                   kLeastRadius_mm, kGreatestRadius_mm));
      }
      const double angle =
          angles.empty() ? 2 * kPi * double(k) / points : RadiansFromDegrees(angles[k] / 100);
      trace.contour_mm.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    traces.push_back(std::move(trace));
  }
  if (traces.size() == 1) {
    OmaTrace other;
    other.eye = traces[0].eye == Eye::kRight ? Eye::kLeft : Eye::kRight;
    other.contour_mm = Mirror(traces[0].contour_mm);
    other.mirrored = true;
    traces.push_back(std::move(other));
  }
  return traces;
}

Result<std::vector<double>> OmaFile::EdgeThickness(Eye eye) const {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (LabelOf(lines_[i].text) != "STHKFMT") continue;
    const std::string value = lines_[i].text.substr(lines_[i].text.find('=') + 1);
    const std::vector<std::string> fields = Split(value, ';');
    double format = 0, points = 0;
    if (fields.size() < 4 || !ReadNumber(fields[0], format) || !ReadNumber(fields[1], points) ||
        format != 1 || !(points >= 1 && points <= double(kMostPoints))) {
      return Failure(name_ + ":STHKFMT: got \"" + value + "\", want 1;points;E;R|L");
    }
    if (fields[3] != Side(eye)) continue;
    LG_ASSIGN(std::vector<double> values, Block(i, "T", std::size_t(points)));
    for (double& v : values) v /= 100;
    return values;
  }
  return std::vector<double>{};
}

void OmaFile::SetBlock(const std::string& format, Eye eye, const std::vector<std::string>& labels,
                       const std::vector<std::string>& lines) {
  const std::string end = lines_.empty() || lines_[0].end.empty() ? "\r\n" : lines_[0].end;
  std::size_t place = lines_.size();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (LabelOf(lines_[i].text) != format) continue;
    const std::vector<std::string> fields = Split(lines_[i].text, ';');
    if (fields.size() < 4 || fields[3] != Side(eye)) continue;
    std::size_t last = i + 1;
    while (last < lines_.size() &&
           std::find(labels.begin(), labels.end(), LabelOf(lines_[last].text)) != labels.end()) {
      ++last;
    }
    lines_.erase(lines_.begin() + long(i), lines_.begin() + long(last));
    place = i;
    break;
  }
  if (!lines_.empty() && lines_.back().end.empty()) lines_.back().end = end;
  for (const std::string& line : lines) {
    lines_.insert(lines_.begin() + long(place++), {line, end});
  }
}

void OmaFile::SetEdgeThickness(Eye eye, const std::vector<double>& thickness_mm,
                               const std::vector<double>& radii_mm) {
  std::vector<std::string> lines = {
      fmt::format("STHKFMT=1;{};E;{}", thickness_mm.size(), Side(eye))};
  AppendHundredths("R", radii_mm, lines);
  AppendHundredths("T", thickness_mm, lines);
  SetBlock("STHKFMT", eye, {"R", "A", "T"}, lines);
}

void OmaFile::SetTrace(Eye eye, const std::vector<double>& radii_mm) {
  std::vector<std::string> lines = {fmt::format("TRCFMT=1;{};E;{};F", radii_mm.size(), Side(eye))};
  AppendHundredths("R", radii_mm, lines);
  SetBlock("TRCFMT", eye, {"R", "A"}, lines);
}

bool IsOmaPath(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return ending == ".oma" || ending == ".vca";
}

double OmaCurveDiopters(double written) {
  return std::abs(written) > kOmaGreatestCurve ? 530 / written : written;
}

}  // namespace lorgnette
