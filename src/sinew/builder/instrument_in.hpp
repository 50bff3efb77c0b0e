/// @file
/// The instrument of a kind in a model under construction.
#pragma once

#include <memory>

#include "sinew/model/model_data.hpp"

namespace sinew::builder {

/// The instrument of a type, which is added if there is none yet. @param data of the model.
template <class T>
T& instrument_in(model::ModelData& data) {
  if (T* present = data.instrument<T>()) return *present;
  data.instruments.push_back(std::make_unique<T>());
  return static_cast<T&>(*data.instruments.back());
}

}  // namespace sinew::builder
