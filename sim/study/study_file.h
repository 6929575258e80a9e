#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/document.h"

namespace dendro::study {

/// One thing that a study varies.
struct StudyAxis {
  std::string key;    ///< "parameters.processor.tick_ns" or a scene key, as for --set; "machine": the machine itself
  std::string label;  ///< for pictures; the key unless the file says otherwise
  bool logarithmic = false;
  std::vector<config::Value> values;
  std::vector<std::string> names;  ///< what stands for every value in pictures and tables, or empty
  config::Where where;

  /// A value as text: its name if it has one, a word without quotes.
  std::string text_of(std::size_t value) const;
  /// Values lie where their size says; otherwise one stands beside the other.
  bool numeric() const;
};

/// A study file: a scene, a machine, and what is varied. docs/sweep.md describes its keys.
struct Study {
  std::string name, description;
  std::string file;     ///< for messages
  std::string scene;    ///< built-in name or path
  std::string machine;  ///< empty: the scene's
  std::vector<std::string> levels;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> settings;  ///< key=value, the same in every run
  std::vector<StudyAxis> axes;
  std::vector<std::string> outputs;        ///< figures of stats::figures(), or `A per B` of two
  std::vector<std::string> output_labels;  ///< for pictures; the outputs unless the file says otherwise
  bool logarithmic = false;                ///< the outputs in pictures
  config::Where scene_where, machine_where, levels_where, settings_where, outputs_where;

  std::size_t runs() const;
  /// The value of every axis at a run; levels vary slowest, the last axis fastest.
  std::vector<std::size_t> place(std::size_t run) const;
  const std::string& level_of(std::size_t run) const;
  /// All key=value settings of a run, without its machine.
  std::vector<std::string> settings_of(std::size_t run) const;
  /// NAME or NAME:PRESET or a file; empty: the scene's.
  std::string machine_of(std::size_t run) const;
};

/// The key of an axis that varies the machine.
constexpr const char* kMachineKey = "machine";

/// The figures that an output is made of: itself, or both of `A per B`.
std::vector<std::string> figures_of(const std::string& output);

/// More runs than this want a word from the user.
constexpr std::size_t kManyRuns = 10000;

struct BuiltInStudy {
  std::string name, path, description;
};

/// The studies that ship with dendro, by name.
std::vector<BuiltInStudy> built_in_studies();

/// Loads a built-in study by name or a file by path and checks its form. Throws UserError with file:line and key; for
/// more than kManyRuns runs unless `many`.
Study load_study(const std::string& name, bool many);

}  // namespace dendro::study
