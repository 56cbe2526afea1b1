// SPDX-License-Identifier: Apache-2.0
// lorgnette lens: from a prescription to the sheet of its lenses, certified by rays, and to files.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/lens_drawing.h"
#include "apps/lens_json.h"
#include "apps/lens_mesh_files.h"
#include "apps/lens_orders.h"
#include "apps/lens_pair.h"
#include "apps/lens_questions.h"
#include "apps/lens_text.h"
#include "apps/lens_zmx.h"
#include "apps/rx_file.h"
#include "base/atomic_file.h"
#include "geometry/frame_io.h"
#include "optics/fhir.h"
#include "optics/sdf.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSdfPitch_mm = 0.5;

struct LensCommandOptions {
  LensOptions lens;
  LensQuestions questions;
  std::string rx, frame;
  std::optional<double> pd_mm, frame_unit_mm, iseikonic;
  double reading_drop_mm = 10;
  bool json = false;
  std::string svg, stl, glb, zmx, sdf, rx_out, fhir_out;
  FhirHeader fhir;
};

// What is to be made, and how far apart.
struct Job {
  std::vector<LensOrder> orders;
  std::optional<Prescription> rx;
  double pd_mm = 64;
};

Status SetContours(const LensCommandOptions& o, Job& job) {
  if (o.frame.empty()) return {};
  if (!job.rx && !o.pd_mm) {
    return UsageError("--frame: got it without a pupillary distance, want --pd");
  }
  LG_ASSIGN(const FrameModel frame, LoadFrame(o.frame, o.frame_unit_mm));
  for (LensOrder& order : job.orders) {
    const bool right = order.eye == Eye::kRight;
    const double pd = job.rx ? (right ? job.rx->pd_right_mm : job.rx->pd_left_mm) : 0.5 * job.pd_mm;
    SetFrameContour(frame, pd,
                    !job.rx ? std::nullopt
                    : right ? job.rx->fitting_height_right_mm
                            : job.rx->fitting_height_left_mm,
                    order);
  }
  return {};
}

Result<Job> JobOf(const LensCommandOptions& o) {
  Job job;
  if (o.rx.empty()) {
    if (o.pd_mm) LG_RETURN_IF_ERROR(CheckRange("--pd", *o.pd_mm, kMinPd_mm, kMaxPd_mm));
    job.pd_mm = o.pd_mm.value_or(job.pd_mm);
    LG_ASSIGN(LensOrder order, OrderFromOptions(o.lens));
    job.orders.push_back(std::move(order));
  } else {
    if (o.lens.sphere_D || o.lens.cylinder_D != 0 || o.lens.axis_deg || o.lens.add_D != 0 ||
        o.lens.prism_in != 0 || o.lens.prism_up != 0) {
      return UsageError("--sphere: got it together with the prescription " + o.rx +
                        ", want one of the two");
    }
    LG_ASSIGN(job.rx, ReadRxFile(o.rx, o.pd_mm));
    job.pd_mm = job.rx->pd_mm();
    LensOptions lens = o.lens;
    if (!lens.refraction_vertex_mm) lens.refraction_vertex_mm = job.rx->vertex_distance_mm;
    LG_ASSIGN(LensOrder right, OrderFromPrescription(job.rx->right, Eye::kRight, lens));
    LG_ASSIGN(LensOrder left, OrderFromPrescription(job.rx->left, Eye::kLeft, lens));
    job.orders = {std::move(right), std::move(left)};
  }
  LG_RETURN_IF_ERROR(SetContours(o, job));
  return job;
}

// name.stl, or name_right.stl and name_left.stl of a pair.
std::string NameFor(const std::string& path, const MadeLens& lens, bool pair) {
  if (!pair) return path;
  const std::filesystem::path whole(path);
  std::filesystem::path name = whole.stem();
  name += lens.design.order.eye == Eye::kRight ? "_right" : "_left";
  name += whole.extension();
  return (whole.parent_path() / name).string();
}

Status WriteSdfOf(const MadeLens& lens, const std::string& path) {
  const LensDesign& design = lens.design;
  const double side = design.min_blank_mm - kBlankAllowance_mm;
  const int nodes = 1 + 2 * int(std::ceil(0.5 * side / kSdfPitch_mm));
  const double width = kSdfPitch_mm * (nodes - 1);
  std::string text;
  for (const SdfFace face : {SdfFace::kFront, SdfFace::kBack}) {
    LG_ASSIGN(const std::string one,
              WriteSdf(face == SdfFace::kFront ? design.lens.front : design.lens.back,
                       design.order.eye, face, nodes, nodes, width, width));
    text += one;
  }
  return WriteFileAtomically(path, text);
}

Status WriteFiles(const LensCommandOptions& o, const Job& job, const std::vector<MadeLens>& lenses,
                  const std::vector<SheetColumn>& columns, const std::vector<Json>& sheets) {
  const bool pair = lenses.size() > 1;
  if (!o.svg.empty()) LG_RETURN_IF_ERROR(WriteFileAtomically(o.svg, LensDrawingSvg(columns)));
  if (!o.glb.empty()) {
    std::vector<GlbLens> parts;
    for (std::size_t i = 0; i < lenses.size(); ++i) {
      parts.push_back({&lenses[i].design, sheets[i].dump()});
    }
    LG_ASSIGN(const std::string glb, GlbOf(parts, job.pd_mm));
    LG_RETURN_IF_ERROR(WriteFileAtomically(o.glb, glb));
  }
  for (const MadeLens& lens : lenses) {
    if (!o.stl.empty()) {
      LG_ASSIGN(const TriangleMesh mesh, MeshOf(lens.design));
      LG_RETURN_IF_ERROR(WriteFileAtomically(NameFor(o.stl, lens, pair),
                                             StlOf(mesh, "lorgnette lens, mm, lens frame")));
    }
    if (!o.zmx.empty()) {
      LG_ASSIGN(const std::string zmx, ZmxOf(lens.design, o.questions.stop_mm));
      LG_RETURN_IF_ERROR(WriteFileAtomically(NameFor(o.zmx, lens, pair), zmx));
    }
    if (!o.sdf.empty()) LG_RETURN_IF_ERROR(WriteSdfOf(lens, NameFor(o.sdf, lens, pair)));
  }
  if (!o.rx_out.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(o.rx_out, WritePrescription(*job.rx)));
  }
  if (!o.fhir_out.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(o.fhir_out, WriteFhir(*job.rx, o.fhir)));
  }
  return {};
}

Status CheckTogether(const LensCommandOptions& o) {
  if (o.rx.empty()) {
    for (const auto& [name, given] : {std::pair{"--iseikonic", o.iseikonic.has_value()},
                                      {"--rx-out", !o.rx_out.empty()},
                                      {"--fhir-out", !o.fhir_out.empty()}}) {
      if (given) return UsageError(fmt::format("{}: want a prescription file, of both eyes", name));
    }
  }
  if (!o.fhir_out.empty() &&
      (o.fhir.patient.empty() || o.fhir.prescriber.empty() || o.fhir.created.empty())) {
    return UsageError(
        "--fhir-out: want --patient, --prescriber and --date too, which FHIR requires");
  }
  return CheckRange("--reading-drop", o.reading_drop_mm, 0, 30);
}

Status RunLens(const LensCommandOptions& o, std::ostream& out) {
  LG_RETURN_IF_ERROR(CheckTogether(o));
  LG_ASSIGN(Job job, JobOf(o));
  LensOptions making = o.lens;
  if (job.rx && !making.refraction_vertex_mm) {
    making.refraction_vertex_mm = job.rx->vertex_distance_mm;
  }
  std::vector<MadeLens> lenses;
  const auto make = [&]() -> Status {
    lenses.clear();
    for (const LensOrder& order : job.orders) {
      LG_ASSIGN(MadeLens lens, MakeLens(order, making));
      lenses.push_back(std::move(lens));
    }
    return {};
  };
  LG_RETURN_IF_ERROR(make());
  std::optional<Iseikonic> iseikonic;
  if (o.iseikonic) {
    LG_ASSIGN(iseikonic, MakeIseikonic(lenses, *o.iseikonic, job.orders));
    LG_RETURN_IF_ERROR(make());
  }

  std::vector<CertifiedLens> certified;
  std::vector<Json> sheets;
  for (const MadeLens& lens : lenses) {
    LG_ASSIGN(CertifiedLens one, Certify(lens.design));
    certified.push_back(std::move(one));
    LG_ASSIGN(Json json, AnsweredJson(lens, making, o.questions));
    json["certificate"] = CertificateJson(certified.back().certificate());
    sheets.push_back(std::move(json));
  }
  std::vector<SheetColumn> columns;
  for (std::size_t i = 0; i < lenses.size(); ++i) {
    LG_ASSIGN(const LensLight light, LightOf(lenses[i].design, making));
    columns.push_back(
        {&certified[i], MakeLensSheet(lenses[i].design, SheetRequest{}), &lenses[i], light});
  }
  LG_RETURN_IF_ERROR(WriteFiles(o, job, lenses, columns, sheets));
  if (!o.json) {
    out << LensSheetText(columns);
    if (job.rx) out << PairText(lenses, o.reading_drop_mm, iseikonic);
    return {};
  }
  // One lens stands at the top level, a pair in a list.
  out << (job.rx
              ? Json{{"lenses", sheets}, {"pair", PairJson(lenses, o.reading_drop_mm, iseikonic)}}
              : sheets.front())
             .dump(2)
      << '\n';
  return {};
}

}  // namespace

void AddLensCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "lens", "Design the lenses of a prescription, measure them by rays, print their sheet");
  const auto o = std::make_shared<LensCommandOptions>();
  command.add_option("--rx,rx", o->rx, "Prescription file (JSON, ours or FHIR); or give --sphere");
  command.add_option("--pd", o->pd_mm, "Distance between the pupils, mm, for the file's");
  AddPowerOptions(command, o->lens);
  AddMakingOptions(command, o->lens);
  command.add_option("--frame", o->frame,
                     "Cut to this frame (a shipped one, or a file): thickness, weight and blank "
                     "over its real outline");
  command.add_option("--frame-unit", o->frame_unit_mm,
                     "mm per unit of a frame file without a unit");
  command
      .add_option("--reading-drop", o->reading_drop_mm,
                  "The pair's vertical imbalance is stated so far below the centres, mm")
      ->capture_default_str();
  command.add_option("--iseikonic", o->iseikonic,
                     "Make both lenses magnify in this ratio, right over left (1: alike)");
  AddQuestionOptions(command, o->questions);
  command.add_flag("--json", o->json, "Print JSON in place of text");
  command.add_option("--svg", o->svg, "Write a lens drawing with maps to this file");
  command.add_option("--stl", o->stl,
                     "Write the lens as a closed mesh, mm (of a pair: NAME_right, NAME_left)");
  command.add_option("--glb", o->glb, "Write the lenses as glTF 2.0 with their material");
  command.add_option("--zmx", o->zmx,
                     "Write a sequential Zemax file (of a pair: NAME_right, NAME_left)");
  command.add_option("--sdf", o->sdf,
                     "Write both surfaces as grids of sags (of a pair: NAME_right, NAME_left)");
  command.add_option("--rx-out", o->rx_out, "Write the prescription as our JSON");
  command.add_option("--fhir-out", o->fhir_out,
                     "Write the prescription as FHIR VisionPrescription");
  command.add_option("--patient", o->fhir.patient, "FHIR reference, as Patient/123");
  command.add_option("--prescriber", o->fhir.prescriber, "FHIR reference, as Practitioner/7");
  command.add_option("--date", o->fhir.created, "FHIR date, as 2026-11-25");
  command.footer(
      "Examples:\n"
      "  lorgnette lens data/prescriptions/table1.json --svg lenses.svg\n"
      "  lorgnette lens --sphere -4.25 --cylinder -0.75 --axis 160 --index 1.6 --json\n"
      "  lorgnette lens --sphere 1 --add 2 --multifocal flat-top --glb lens.glb --stl lens.stl\n"
      "  lorgnette lens rx.json --frame panto --pantoscopic 8 --vertex 12");
  command.final_callback([o, &context] {
    o->fhir.date_written = o->fhir.created;
    context.status = RunLens(*o, context.out);
  });
}

}  // namespace lorgnette
