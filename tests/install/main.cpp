// Uses the library as an outside program would: by its installed headers and targets alone.
#include <cstdlib>
#include <iostream>

#include "sinew/sinew.hpp"

namespace {

void expect(bool condition, const char* what) {
  if (condition) return;
  std::cerr << "failed: " << what << '\n';
  std::exit(EXIT_FAILURE);
}

void throws_the_librarys_errors() {
  try {
    throw sinew::Error(sinew::ErrorKind::file_not_found, {.file = "trunk.yaml"}, "no such file");
  } catch (const sinew::Error& error) {
    expect(error.kind() == sinew::ErrorKind::file_not_found, "the kind of an error");
  }
}

}  // namespace

int main() {
  throws_the_librarys_errors();
  return EXIT_SUCCESS;
}
