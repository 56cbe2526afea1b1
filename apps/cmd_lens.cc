// SPDX-License-Identifier: Apache-2.0
// lorgnette lens: from a prescription to the sheet of its lenses, certified by rays.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/lens_drawing.h"
#include "apps/lens_json.h"
#include "apps/lens_options.h"
#include "apps/lens_text.h"
#include "apps/rx_file.h"
#include "base/atomic_file.h"

namespace lorgnette {
namespace {

struct LensCommandOptions {
  LensOptions lens;
  std::string rx;
  std::optional<double> pd_mm;
  bool json = false;
  std::string svg;
};

Result<std::vector<LensOrder>> Orders(const LensCommandOptions& options) {
  if (options.rx.empty()) {
    LG_ASSIGN(LensOrder order, OrderFromOptions(options.lens));
    return std::vector<LensOrder>{std::move(order)};
  }
  if (options.lens.sphere_D || options.lens.cylinder_D != 0 || options.lens.axis_deg) {
    return UsageError("--sphere: got it together with the prescription " + options.rx +
                      ", want one of the two");
  }
  LG_ASSIGN(const Prescription rx, ReadRxFile(options.rx, options.pd_mm));
  LensOptions lens = options.lens;
  lens.vertex_distance_mm = rx.vertex_distance_mm;
  LG_ASSIGN(LensOrder right, OrderFromPrescription(rx.right, Eye::kRight, lens));
  LG_ASSIGN(LensOrder left, OrderFromPrescription(rx.left, Eye::kLeft, lens));
  return std::vector<LensOrder>{std::move(right), std::move(left)};
}

Status RunLens(const LensCommandOptions& options, std::ostream& out) {
  LG_ASSIGN(const std::vector<LensOrder> orders, Orders(options));
  std::vector<CertifiedLens> lenses;
  for (const LensOrder& order : orders) {
    LG_ASSIGN(LensDesign design, DesignLens(order));
    LG_ASSIGN(CertifiedLens lens, Certify(std::move(design)));
    lenses.push_back(std::move(lens));
  }
  std::vector<SheetColumn> columns;
  for (const CertifiedLens& lens : lenses) {
    columns.push_back({&lens, MakeLensSheet(lens.design(), SheetRequest{})});
  }
  if (!options.svg.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(options.svg, LensDrawingSvg(columns)));
  }
  if (!options.json) {
    out << LensSheetText(columns);
    return {};
  }
  nlohmann::ordered_json sheets = nlohmann::ordered_json::array();
  for (const SheetColumn& column : columns) {
    nlohmann::ordered_json json = LensJson(column.lens->design(), column.sheet);
    json["certificate"] = CertificateJson(column.lens->certificate());
    sheets.push_back(std::move(json));
  }
  // One lens stands at the top level, a pair in a list.
  out << (options.rx.empty() ? sheets.front() : nlohmann::ordered_json{{"lenses", sheets}}).dump(2)
      << '\n';
  return {};
}

}  // namespace

void AddLensCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "lens", "Design the lenses of a prescription, measure them by rays, print their sheet");
  const auto options = std::make_shared<LensCommandOptions>();
  command.add_option("rx", options->rx, "Prescription file (JSON); or give --sphere");
  command.add_option("--pd", options->pd_mm, "Distance between the pupils, mm, for the file's");
  AddPowerOptions(command, options->lens);
  AddMakingOptions(command, options->lens);
  command.add_flag("--json", options->json, "Print JSON in place of text");
  command.add_option("--svg", options->svg, "Write a lens drawing to this file");
  command.footer(
      "Examples:\n"
      "  lorgnette lens data/prescriptions/table1.json --svg lenses.svg\n"
      "  lorgnette lens --sphere -4.25 --cylinder -0.75 --axis 160 --index 1.6 --json");
  command.final_callback([options, &context] { context.status = RunLens(*options, context.out); });
}

}  // namespace lorgnette
