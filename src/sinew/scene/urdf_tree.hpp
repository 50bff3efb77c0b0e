/// @file
/// A URDF file as XML: locations of elements, connections of links, and elements that are not used.
/// Values are read in urdf.cpp. Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"

namespace sinew::scene {

/// The checked tree of a URDF file: names are unique, every joint has a parent and a child, and the
/// links form a tree with one root.
class UrdfTree {
 public:
  /// Throws what parse_urdf() throws, except for errors in values. @param text,name as for
  /// parse_urdf().
  UrdfTree(std::string_view text, std::string name);

  /// Elements `<link>` and `<joint>`, each link after its parent. Link k + 1 is the child of joint
  /// k.
  const std::vector<pugi::xml_node>& links() const { return links_; }
  const std::vector<pugi::xml_node>& joints() const { return joints_; }
  /// Position of a link's name among links(), or -1.
  int link_number(std::string_view link) const;

  Location place(const pugi::xml_node& element) const;
  /// Location of the element whose name a message has in brackets or quotes; by default the file.
  Location place_named_in(const std::string& message) const;
  /// One notice for each kind of element or attribute that is not used.
  const std::vector<Notice>& notices() const { return notices_; }
  /// The tree as XML text, with links and joints only.
  std::string text() const;

 private:
  void read_elements();
  void check_link(const pugi::xml_node& link);
  void check_joint(const pugi::xml_node& joint);
  void refuse_formats(pugi::xml_node& element) const;
  void check_tie(const pugi::xml_node& joint);
  void check_name(const pugi::xml_node& element, const std::vector<pugi::xml_node>& others) const;
  void sort_from_root();
  void ignore(const pugi::xml_node& element, const std::string& what);

  std::string name_;
  std::string source_;
  pugi::xml_document document_;
  std::vector<pugi::xml_node> links_, joints_;
  std::vector<Notice> notices_;
};

}  // namespace sinew::scene
