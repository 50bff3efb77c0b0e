// sinew materials: the library of silicones.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/material/instability.hpp"
#include "sinew/material/library.hpp"

#include "commands.hpp"
#include "material_text.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

using material::NamedMaterial;

// What to know before a law is used.
std::string caution(const NamedMaterial& law) {
  if (!material::instability(law.energy).empty()) return "unstable";
  if (law.soft_below > 0.0) return fmt::format("too soft below {:g}", law.soft_below);
  return "";
}

void print_library() {
  std::vector<std::vector<std::string>> rows = {
      {"name", "law", "E, kPa", "tested stretch", "error", "E measured, kPa", "caution"}};
  for (const NamedMaterial& law : material::material_library()) {
    rows.push_back(
        {law.name, law.law, fmt::format("{:.4g}", 1e-3 * law.energy.young_modulus()),
         tested_text(law), error_text(law),
         law.measured_modulus > 0.0 ? fmt::format("{:.4g}", 1e-3 * law.measured_modulus) : "-",
         caution(law)});
  }
  fmt::print("{}", format_table(rows));
}

void print_entry(const NamedMaterial& law) {
  std::vector<std::vector<std::string>> rows = {
      {"name", law.name},
      {"silicone", law.trade_name},
      {"law", law.law},
      {"Young's modulus at small strain",
       fmt::format("{:.4g} kPa", 1e-3 * law.energy.young_modulus())},
      {"tested stretch", tested_text(law)},
      {"largest error there", error_text(law)},
      {"density", fmt::format("{:g} kg/m^3", law.density)}};
  fmt::print("{}\nSource: {}.\n", format_table(rows), law.source);
  if (law.measured_modulus > 0.0) {
    fmt::print("Measured at small strain: {:.4g} kPa; {}.\n", 1e-3 * law.measured_modulus,
               law.measured_by);
  }
  if (const std::string where = material::instability(law.energy); !where.empty()) {
    fmt::print("Unstable {}.\n", where);
  }
  if (law.soft_below > 0.0) {
    fmt::print("Too soft where no stretch exceeds {:g}: {}.\n", law.soft_below,
               material::small_strain_remedy(law));
  }
  if (!law.remark.empty()) fmt::print("{}\n", law.remark);
}

}  // namespace

void add_materials(CommandLine& line) {
  Command command = line.add_command("materials", "Print the library of silicones");
  const auto name = std::make_shared<std::string>();
  command.add_option("NAME", *name, "Entry to describe with its source (default: a table of all)");
  command.footer("Examples:\n  sinew materials\n  sinew materials dragon-skin-10");
  command.set_action([name] {
    if (name->empty()) {
      print_library();
    } else {
      print_entry(material::named_material(*name));
    }
    return 0;
  });
}

}  // namespace sinew::cli
