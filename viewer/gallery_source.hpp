/// @file
/// The gallery, from which the user opens an example.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "source.hpp"

namespace sinew::viewer {

/// A scene in the gallery.
struct Example {
  std::string name;   ///< folder, and file without extension: "trunk/circle"
  std::string title;  ///< first sentence of the scene's first comment
  std::filesystem::path scene, thumbnail;
};

/// Finds the scenes in a folder, sorted by name.
/// @param folder of examples; each *.yaml in it or in one of its subfolders is one.
std::vector<Example> find_examples(const std::filesystem::path& folder);

/// A source that shows no robot, but a list of examples. It opens only names in this list.
class GallerySource final : public Source {
 public:
  /// @param examples see find_examples().
  explicit GallerySource(std::vector<Example> examples);

  std::string_view mode() const override { return "gallery"; }
  const Description& description() const override { return description_; }
  void start(Publisher& publisher) override;
  void stop() override {}
  void submit(const Request& request, std::function<void(Outcome)> done) override;
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

 private:
  const Example& find(const std::string& name) const;

  std::vector<Example> examples_;
  Description description_;
  Publisher* publisher_ = nullptr;
};

}  // namespace sinew::viewer
