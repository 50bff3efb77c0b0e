// Reads materials: laws, files and names of the library.
#include <filesystem>
#include <string>
#include <utility>

#include "sinew/material/library.hpp"
#include "sinew/material/scaled.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

void read_softening(const Fields& fields, material::Hyperelastic& energy) {
  if (fields.find("softening") == nullptr) return;
  const Fields effect = fields.below("softening");
  material::MullinsEffect& mullins = energy.mullins.emplace();
  effect.read("r", mullins.r);
  effect.read("m", mullins.m);
  effect.read("beta", mullins.beta);
}

/// Reads the Prony series. Returns whether the moduli of the law are instantaneous.
bool read_viscosity(const Fields& fields, material::Hyperelastic& energy) {
  const Node* series = fields.find("viscosity");
  if (series == nullptr) return false;
  for (const Node& item : series->items()) {
    const Fields part(item, select_form(item, fields.form("viscosity").items, {}));
    material::PronyTerm term;
    part.read("relative_modulus", term.relative_modulus);
    part.read("relaxation_time", term.relaxation_time);
    energy.prony.push_back(term);
  }
  bool instantaneous = false;
  fields.read_choice("moduli", instantaneous, {{"long-term", false}, {"instantaneous", true}});
  return instantaneous;
}

// Reads what all hyperelastic laws share, and checks the law.
void read_history(const Fields& fields, MaterialDescription& material) {
  read_softening(fields, material.energy);
  const bool instantaneous = read_viscosity(fields, material.energy);
  at_place(material.place, [&] { material.energy.validate("material"); });
  if (instantaneous) material.energy = material::relaxed(material.energy);
}

void use_library(const std::string& name, MaterialDescription& material) {
  const material::NamedMaterial& named = material::named_material(name);
  material.model = MaterialModel::hyperelastic;
  material.energy = named.energy;
  material.library = named.name;
  material.density = named.density;
}

// Multiplies the stiffness by the factor under `scale`.
void stiffen(const Fields& fields, MaterialDescription& material) {
  double factor = 1.0;
  material.scaled = fields.read("scale", factor) || material.scaled;
  material.young_modulus *= factor;
  material.energy = material::scaled(material.energy, factor);
}

// Reads a file that has the content of `material`. Such a file cannot refer to another file.
MaterialDescription read_material_file(const Fields& body, const ReadContext& context) {
  const std::filesystem::path path = context.path(body.below("material"), "file");
  const KeyTable& table = body.table();
  if (context.files == Files::ignore) return {};
  Node around = Node::map();
  around.set("material", read_yaml(path));
  around.name_paths();
  around.set_place({.file = path.string(), .item = "material"});
  const Node& written = *around.find("material");
  check_value(written, table.find("material")->forms);
  const Fields fields(around, table);
  if (fields.form("material").telltale == "file") {
    throw Error(ErrorKind::wrong_type, written.place(), "the file names another file",
                "write the material itself");
  }
  return read_material(fields, context);
}

}  // namespace

double read_number(const Fields& fields, const char* key) {
  double value = 0.0;
  fields.read(key, value);
  return value;
}

void set_energy(const Fields& fields, material::Hyperelastic energy,
                MaterialDescription& material) {
  double poisson = 0.0;
  const bool by_ratio = fields.read("poisson_ratio", poisson);
  energy.bulk_modulus = by_ratio ? material::bulk_modulus_of(energy.shear_modulus(), poisson)
                                 : read_number(fields, "bulk_modulus");
  material.model = MaterialModel::hyperelastic;
  material.energy = std::move(energy);
}

MaterialDescription read_material(const Fields& body, const ReadContext& context) {
  MaterialDescription material;
  material.place = body.place("material");
  const Form& form = body.form("material");
  if (form.shape == Shape::choice) {
    std::string name;
    body.read_word("material", name);
    use_library(name, material);
    return material;
  }
  const Fields fields = body.below("material");
  if (form.telltale == "file") {
    material = read_material_file(body, context);
    stiffen(fields, material);
    return material;
  }
  if (form.telltale == "name") {
    std::string name;
    fields.read_word("name", name);
    use_library(name, material);
    stiffen(fields, material);
    return material;
  }
  const bool named = form.shape == Shape::variants;
  const MaterialKind& law =
      named ? material_kind(read_text(*fields.map().find(form.telltale))) : corotational_kind();
  law.read(fields, material);
  if (material.is_hyperelastic()) read_history(fields, material);
  return material;
}

}  // namespace sinew::scene
