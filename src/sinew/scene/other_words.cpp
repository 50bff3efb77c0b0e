#include "sinew/scene/other_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace sinew::scene {

namespace {

struct OtherWord {
  std::string_view word;     // in lower case, letters and digits only
  std::string_view current;  // in a scene
};

// Elements by their names in Abaqus and CalculiX, Gmsh and VTK, and in text books. A word may have
// several meanings; the first that is allowed where it stands is taken.
constexpr std::array kOtherWords = {
    OtherWord{"tendon", "cable"},
    OtherWord{"wire", "cable"},
    OtherWord{"rope", "cable"},
    OtherWord{"string", "cable"},
    OtherWord{"pneumatic", "chamber"},
    OtherWord{"pneu", "chamber"},
    OtherWord{"pneumaticchamber", "chamber"},
    OtherWord{"fluidic", "chamber"},
    OtherWord{"hydraulic", "chamber"},
    OtherWord{"cavity", "chamber"},
    OtherWord{"air", "chamber"},
    OtherWord{"balloon", "chamber"},
    OtherWord{"bellow", "chamber"},
    OtherWord{"box", "block"},
    OtherWord{"cuboid", "block"},
    OtherWord{"brick", "block"},
    OtherWord{"cube", "block"},
    OtherWord{"beam", "block"},
    OtherWord{"bar", "block"},
    OtherWord{"rod", "cylinder"},
    OtherWord{"disc", "cylinder"},
    OtherWord{"disk", "cylinder"},
    OtherWord{"tube", "hollow-cylinder"},
    OtherWord{"pipe", "hollow-cylinder"},
    OtherWord{"ball", "sphere"},
    OtherWord{"finger", "ribbed-finger"},
    OtherWord{"pneunet", "ribbed-finger"},
    OtherWord{"frustum", "cone"},
    OtherWord{"c3d4", "tet4"},
    OtherWord{"c3d4h", "tet4"},
    OtherWord{"tetra4", "tet4"},
    OtherWord{"t4", "tet4"},
    OtherWord{"tetrahedron", "tet4"},
    OtherWord{"tetrahedra", "tet4"},
    OtherWord{"p1", "tet4"},
    OtherWord{"c3d10", "tet10"},
    OtherWord{"c3d10h", "tet10"},
    OtherWord{"c3d10m", "tet10"},
    OtherWord{"tetra10", "tet10"},
    OtherWord{"t10", "tet10"},
    OtherWord{"p2", "tet10"},
    OtherWord{"quadratic", "tet10"},
    OtherWord{"c3d8", "hex8"},
    OtherWord{"c3d8r", "hex8"},
    OtherWord{"c3d8h", "hex8"},
    OtherWord{"c3d8i", "hex8"},
    OtherWord{"hexa8", "hex8"},
    OtherWord{"h8", "hex8"},
    OtherWord{"hexahedron", "hex8"},
    OtherWord{"hexahedra", "hex8"},
    OtherWord{"q1", "hex8"},
    OtherWord{"revolute", "hinge"},
    OtherWord{"pin", "hinge"},
    OtherWord{"prismatic", "slider"},
    OtherWord{"translational", "slider"},
    OtherWord{"spherical", "ball"},
    OtherWord{"cardan", "universal"},
    OtherWord{"rigidjoint", "weld"},
    OtherWord{"tie", "weld"},
    OtherWord{"glue", "weld"},
    OtherWord{"bond", "weld"},
    OtherWord{"fixed", "weld"},
    OtherWord{"svk", "saint-venant-kirchhoff"},
    OtherWord{"stvk", "saint-venant-kirchhoff"},
    OtherWord{"stvenantkirchhoff", "saint-venant-kirchhoff"},
    OtherWord{"hooke", "linear"},
    OtherWord{"linearelastic", "linear"},
    OtherWord{"rotated", "corotational"},
    OtherWord{"neohooke", "neo-hookean"},
    OtherWord{"nh", "neo-hookean"},
    OtherWord{"mooney", "mooney-rivlin"},
    OtherWord{"implicit", "backward-euler"},
    OtherWord{"impliciteuler", "backward-euler"},
    OtherWord{"euler", "backward-euler"},
    OtherWord{"newmark", "generalized-alpha"},
    OtherWord{"hht", "generalized-alpha"},
    OtherWord{"generalisedalpha", "generalized-alpha"},
    OtherWord{"static", "quasi-static"},
    OtherWord{"quasistatic", "quasi-static"},
    OtherWord{"loadcell", "cable-tension"},
    OtherWord{"encoder", "cable-length"},
    OtherWord{"imu", "accelerometer"},
    OtherWord{"gyro", "gyroscope"},
    OtherWord{"straingauge", "resistance"},
    OtherWord{"gravitational", "acceleration"},
    OtherWord{"bodyforce", "acceleration"},
    OtherWord{"constantcurvature", "pcc"},
    OtherWord{"e", "young_modulus"},
    OtherWord{"modulus", "young_modulus"},
    OtherWord{"elasticmodulus", "young_modulus"},
    OtherWord{"youngs", "young_modulus"},
    OtherWord{"youngsmodulus", "young_modulus"},
    OtherWord{"nu", "poisson_ratio"},
    OtherWord{"poisson", "poisson_ratio"},
    OtherWord{"poissonsratio", "poisson_ratio"},
    OtherWord{"rho", "density"},
    OtherWord{"massdensity", "density"},
    OtherWord{"shearmodulus", "mu"},
    OtherWord{"frictioncoefficient", "friction"},
    OtherWord{"mu", "friction"},
    OtherWord{"dt", "time_step"},
    OtherWord{"timestep", "time_step"},
    OtherWord{"stepsize", "time_step"},
    OtherWord{"endtime", "duration"},
    OtherWord{"tend", "duration"},
    OtherWord{"totaltime", "duration"},
    OtherWord{"tendons", "actuators"},
    OtherWord{"cables", "actuators"},
    OtherWord{"muscles", "actuators"},
    OtherWord{"motors", "actuators"},
    OtherWord{"markers", "effectors"},
    OtherWord{"endeffectors", "effectors"},
    OtherWord{"tips", "effectors"},
    OtherWord{"endeffector", "effectors"},
    OtherWord{"boundary", "fixed"},
    OtherWord{"boundaryconditions", "fixed"},
    OtherWord{"clamped", "fixed"},
    OtherWord{"constraints", "joints"},
    OtherWord{"forces", "loads"},
    OtherWord{"collisions", "contacts"},
    OtherWord{"geometry", "mesh"},
    OtherWord{"filename", "file"},
    OtherWord{"path", "file"},
    OtherWord{"resolution", "element_size"},
    OtherWord{"meshsize", "element_size"},
    OtherWord{"maxtension", "limits"},
    OtherWord{"stroke", "displacement"},
    OtherWord{"waypoints", "points"},
    OtherWord{"viapoints", "points"},
};

std::string plain(std::string_view word) {
  std::string result;
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) result += static_cast<char>(std::tolower(byte));
  }
  return result;
}

}  // namespace

std::string word_for(std::string_view word, const std::vector<std::string>& known) {
  const std::string written = plain(word);
  for (const OtherWord& other : kOtherWords) {
    if (other.word != written) continue;
    const auto found = std::ranges::find(known, other.current);
    if (found != known.end()) return *found;
  }
  return {};
}

}  // namespace sinew::scene
