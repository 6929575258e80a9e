#pragma once

#include <string>
#include <vector>

#include "sim/scene/image_io.h"
#include "sim/study/sweep.h"

namespace dendro::study {

/// One line per run: its place on the axes, outputs, seed, git state, and every resolved parameter.
std::string sweep_csv(const Study& study, const std::vector<SweepRow>& rows);

/// The contract's object with `schema` and `command`: axes, and per run its settings and outputs.
std::string sweep_json(const Study& study, const SweepOutcome& outcome);

/// The runs as a table to read; more than `most` of them are cut short.
std::string sweep_text(const Study& study, const std::vector<SweepRow>& rows, std::size_t most);

/// True when the study has a picture: one or two axes of more than one point.
bool has_picture(const Study& study);

/// The response of one output: a curve per level over one axis; over two axes a heat map of the first level.
scene::RgbImage sweep_picture(const Study& study, const std::vector<SweepRow>& rows, const std::string& output);

}  // namespace dendro::study
