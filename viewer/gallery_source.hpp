/// @file
/// The examples, to choose one of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "source.hpp"

namespace sinew::viewer {

/// A scene that the gallery offers.
struct Example {
  std::string name;   ///< "trunk/circle": folder and file without extension
  std::string title;  ///< the first sentence of the scene's first comment
  std::filesystem::path scene, thumbnail;
};

/// The scenes below a folder, by name.
/// @param folder of examples; each *.yaml in it or in one of its folders is one.
std::vector<Example> find_examples(const std::filesystem::path& folder);

/// Shows no robot, only what there is to open. Opening goes by names of its own list.
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
