/// @file
/// Visits everything on which the motion of a robot depends, part by part: one visit gives the
/// hashes by which two robots tell in which parts they differ, and lists the numbers that are
/// parameters, with their names and units.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/core/named_hash.hpp"
#include "sinew/core/types.hpp"

namespace sinew {

/// A physical number on which the motion of a robot depends.
struct Parameter {
  /// Dotted. Where a scene states the number itself, the path is that of the scene:
  /// "bodies.finger.parts.tip.material.young_modulus". Components of vectors end with .x, .y, .z.
  std::string path;
  std::string unit;  ///< SI; empty for numbers without dimension
  double value = 0.0;

  bool operator==(const Parameter&) const = default;
};

/// Visits one part. What is added is hashed in order; numbers are hashed and listed.
class PartVisitor {
 public:
  /// Only hashes.
  PartVisitor() = default;
  /// @param path of the part, before the names of its numbers. @param list receives the parameters;
  ///   may be null, else must outlive this.
  PartVisitor(std::string path, std::vector<Parameter>* list)
      : path_(std::move(path)), list_(list) {}

  /// Adds data that are no parameters: lists of nodes, kinds, texts; see ValueHash.
  template <class... Values>
  PartVisitor& add(const Values&... values) {
    hash_.add(values...);
    return *this;
  }
  /// Adds a parameter. @param name after the path of the part. @param unit SI. @param value in it.
  PartVisitor& number(std::string_view name, std::string_view unit, double value) {
    hash_.add(value);
    list(name, unit, value);
    return *this;
  }
  PartVisitor& number(std::string_view name, std::string_view unit, const Vector3& value);
  /// Lists nothing if there is no value.
  PartVisitor& number(std::string_view name, std::string_view unit,
                      const std::optional<double>& value);
  /// Lists a parameter without adding it to the hash, which contains it in another form.
  PartVisitor& list(std::string_view name, std::string_view unit, double value);
  /// Visits a value that may be absent: visit(*this, value) adds it.
  template <class T, class Visit>
  PartVisitor& optional(const std::optional<T>& value, Visit&& visit) {
    hash_.add(static_cast<std::uint64_t>(value.has_value()));
    if (value) visit(*this, *value);
    return *this;
  }
  /// Calls visit() with the path extended by a name.
  template <class Visit>
  PartVisitor& below(std::string_view name, Visit&& visit) {
    const std::size_t size = path_.size();
    if (list_ != nullptr) (path_ += '.') += name;
    visit();
    path_.resize(size);
    return *this;
  }

  /// A visitor with the same path and list, and a hash of its own.
  PartVisitor same() const { return {path_, list_}; }

  std::uint64_t hash() const { return hash_.value(); }

 private:
  ValueHash hash_;
  std::string path_;
  std::vector<Parameter>* list_ = nullptr;
};

/// Visits the parts of a body, or of a whole model.
class PartsVisitor {
 public:
  /// @param parameters receives the parameters; may be null, else must outlive this.
  explicit PartsVisitor(std::vector<Parameter>* parameters = nullptr) : list_(parameters) {}

  /// Begins a part; valid as long as this. Parts are hashed in the order of these calls.
  /// @param name such as "material". @param path of its parameters; none: that of the body.
  PartVisitor& part(const std::string& name, const std::optional<std::string>& path = {});
  /// The names of all parts that begin from now on get a prefix, and those without a path of their
  /// own this one. @param prefix such as "body 'trunk': ". @param path such as "bodies.trunk".
  void enter(std::string prefix, std::string path);
  /// Names and hashes of all parts.
  std::vector<NamedHash> hashes() const;

 private:
  struct Part {
    std::string name;
    PartVisitor visitor;
  };
  std::string prefix_, path_;
  std::vector<Parameter>* list_;
  std::deque<Part> parts_;
};

}  // namespace sinew
