#include "firmware/zbuffer_views/job.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "firmware/zbuffer_views/host/files.h"
#include "firmware/zbuffer_views/host/prepare.h"
#include "firmware/zbuffer_views/host/saved_views.h"
#include "firmware/zbuffer_views/reference/reference.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"
#include "sim/base/error.h"

namespace dendro::zbuffer_views {
namespace {

/// Pictures of a sequence that one run of a program may hold: they stay in memory until they are written.
constexpr std::size_t kMostPictureBytes = 16 << 20;

constexpr const char *kJob = "job", *kTree = "tree", *kViews = "views", *kPictures = "pictures";

double squares_of(const std::vector<std::uint8_t>& rgb, const ReferencePicture& wanted) {
  double sum = 0;
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const double difference = rgb[i] - std::round(wanted.rgb[i]);
    sum += difference * difference;
  }
  return sum;
}

class ViewsJob : public ProgramJob {
 public:
  ViewsJob(const scene::Scene& scene, Programs programs) : prepared_(prepare(scene, settings_)), programs_(std::move(programs)) {
    tree_ = tree_file(prepared_.tree);
    digest_ = digest_of(tree_);
    if (settings_.views_file.empty()) return;
    const bool folder = std::filesystem::is_directory(settings_.views_file);
    if (folder || !saved_views_.read_from(settings_.views_file))
      throw UserError(settings_.views_file, 0, "", folder ? "cannot be read: it is a folder" : "cannot be read");
    check_views(saved_views_, prepared_, digest_, settings_.views_file);
    check_saved_views(saved_views_, settings_.views_file);
  }

  void run_programs(Workstation& workstation) override {
    const std::string made_from = views_made_from(tree_, prepared_.views);
    workstation.file(kTree) = std::move(tree_);
    if (settings_.polygons) return draw(workstation, "zbuffer_views_polygons", kTree);
    base::ScratchFile& views = workstation.large_file(kViews);
    if (settings_.views_file.empty()) {
      make_views(workstation, made_from);
    } else {
      views = std::move(saved_views_);
    }
    Bytes().swap(workstation.file(kTree));
    stored_ = check_views(views, prepared_, digest_, kViews);
    stored_bytes_ = views.size();
    if (settings_.save_views) {
      put_checksum(views);
      workstation.keep("views.zbv", views);
      take_checksum(views);
    }
    draw(workstation, "zbuffer_views_reconstruct", kViews);
  }

  std::string phase_name(std::uint32_t label) const override {
#define ZBV_PHASE_NAME(name, number, text) \
  if (label == number) return text;
    ZBV_PHASES(ZBV_PHASE_NAME)
#undef ZBV_PHASE_NAME
    return "";
  }

  int width() const override { return prepared_.width; }
  int height() const override { return prepared_.height; }
  const std::vector<std::uint8_t>& rgb() const override { return first_.rgb; }

  ErrorReport compare(const MachineView&) const override {
    const ReferencePicture& wanted = reference();
    ErrorReport report;
    report.covered_pixels = wanted.covered();
    const double pitch = window_pitch(prepared_.tree, prepared_.views);
    std::int64_t wrong_depths = 0, wrong_shadows = 0, compared = 0;
    for (std::size_t i = 0; i < wanted.colour.size(); ++i) {
      const bool covered = first_.colour[i] != kZbvEmptyColour, wanted_covered = wanted.colour[i] != kNoColour;
      report.wrong_pixels += covered != wanted_covered || wanted.colour[i] != first_.colour[i];
      if (!covered || !wanted_covered) continue;
      ++compared;
      const double error = std::abs(first_.depth[i] - wanted.depth[i]);
      report.max_depth_error = std::max(report.max_depth_error, error);
      wrong_depths += error > pitch;
    }
    const double squares = squares_of(first_.rgb, wanted), values = static_cast<double>(first_.rgb.size());
    if (squares > 0) report.psnr_db = 10 * std::log10(255.0 * 255.0 * values / squares);
    if (prepared_.shadows) {
      const auto dark = std::count(wanted.shadow.begin(), wanted.shadow.end(), 1);
      wrong_shadows = std::abs(static_cast<std::int64_t>(first_.shadowed) - static_cast<std::int64_t>(dark));
      report.extra.emplace_back("shadowed_pixels", first_.shadowed);
      report.extra.emplace_back("shadowed_difference", static_cast<double>(wrong_shadows));
    }
    report.extra.emplace_back("depth_differs_pixels", static_cast<double>(wrong_depths));
    if (!settings_.polygons) add_holes(report);
    return report;
  }

  std::vector<Layer> layers(const MachineView&) const override {
    const ReferencePicture& wanted = reference();
    std::vector<Layer> layers;
    for (const char* name : {"R", "G", "B", "Z", "index.colour", "reference.R", "reference.G", "reference.B", "reference.Z",
                             "reference.colour"})
      layers.push_back({name, std::vector<float>(first_.depth.size())});
    const auto index = [](std::uint8_t colour) { return colour == kNoColour ? -1.0f : static_cast<float>(colour); };
    for (std::size_t i = 0; i < first_.depth.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        layers[c].values[i] = static_cast<float>(first_.rgb[3 * i + c]) / 255.0f;
        layers[5 + c].values[i] = static_cast<float>(wanted.rgb[3 * i + c] / 255);
      }
      layers[3].values[i] = first_.depth[i];
      layers[4].values[i] = index(first_.colour[i]);
      layers[8].values[i] = std::isfinite(wanted.depth[i]) ? static_cast<float>(wanted.depth[i]) : kZbvFarDepth;
      layers[9].values[i] = index(wanted.colour[i]);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override {
    std::vector<std::string> files = prepared_.tree.model.files;
    if (!settings_.views_file.empty()) files.push_back(settings_.views_file);
    std::sort(files.begin(), files.end());
    return files;
  }

  std::vector<FirmwareImage> firmware() const override {
    if (settings_.polygons) return {programs_.images[2]};
    if (!settings_.views_file.empty()) return {programs_.images[1]};
    return {programs_.images[0], programs_.images[1]};
  }

  std::vector<std::pair<std::string, double>> facts() const override {
    const Tree& tree = prepared_.tree;
    const ViewSettings& v = prepared_.views;
    const auto count = [](auto n) { return static_cast<double>(n); };
    std::vector<std::pair<std::string, double>> facts = {{"triangles", count(tree.model.triangles.size())},
                                                         {"vertices", count(tree.model.vertices.size())},
                                                         {"trees", count(prepared_.placements.size())},
                                                         {"frames", count(prepared_.frames.size())},
                                                         {"tree.height_metres", 2 * tree.half_height},
                                                         {"tree.radius_metres", tree.radius}};
    for (const Part part : {Part::kTrunk, Part::kBranch, Part::kLeaf}) {
      static constexpr const char* kNames[] = {"triangles.trunk", "triangles.branch", "triangles.leaf"};
      facts.emplace_back(kNames[static_cast<int>(part)], count(std::count(tree.model.parts.begin(), tree.model.parts.end(), part)));
    }
    if (stored_.views == 0) return facts;
    const double samples = count(v.width) * v.height * v.layers;
    facts.insert(facts.end(), {{"views", stored_.views},
                               {"views.bytes_each", samples * kZbvSampleBytes},
                               {"views.bytes", count(stored_bytes_)},
                               {"views.pitch_metres", stored_.pitch},
                               {"samples.camera", samples * first_.camera_views},
                               {"samples.light", samples * first_.light_views}});
    return facts;
  }

 private:
  std::string name_of(const std::string& program) const { return program + programs_.suffix; }

  void make_views(Workstation& workstation, const std::string& made_from) {
    const std::string program = name_of("zbuffer_views_precompute");
    const std::vector<std::string> arguments = {kJob, kTree, kViews};
    workstation.file(kJob) = job_file(prepared_, digest_, 0, 1);
    if (settings_.time_precompute) return workstation.run(program, arguments, true);
    workstation.make(program, arguments, kViews, made_from, [&](const base::ScratchFile& kept) {
      try {
        return check_views(kept, prepared_, digest_, kViews).views > 0;
      } catch (const UserError&) {
        return false;
      }
    });
  }

  void draw(Workstation& workstation, const std::string& program, const char* source) {
    const std::size_t bytes = static_cast<std::size_t>(prepared_.width) * static_cast<std::size_t>(prepared_.height) * 8;
    const std::size_t most = std::max<std::size_t>(1, kMostPictureBytes / bytes);
    for (std::size_t at = 0; at < prepared_.frames.size(); at += most) {
      const std::size_t count = std::min(most, prepared_.frames.size() - at);
      workstation.file(kJob) = job_file(prepared_, digest_, at, count);
      workstation.run(name_of(program), {kJob, source, kPictures}, true);
      std::vector<DrawnPicture> pictures = read_pictures(workstation.file(kPictures), prepared_, digest_);
      Bytes().swap(workstation.file(kPictures));
      DENDRO_CHECK(pictures.size() == count, "{} of {}", pictures.size(), count);
      if (settings_.animate)
        for (const DrawnPicture& picture : pictures) workstation.show(prepared_.width, prepared_.height, picture.rgb);
      if (at == 0) first_ = std::move(pictures.front());
    }
  }

  /// Of the first frame, with the canonical layers: only the views that it needs.
  const ReferencePicture& reference() const {
    if (!reference_) {
      const Frame& frame = prepared_.frames.front();
      Prepared p = prepared_;
      p.views.peel = true;
      reference_ = settings_.polygons ? draw_polygons(p, frame) : reconstruct(p, needed_views(p, frame), frame);
    }
    return *reference_;
  }

  /// What reprojection misses: pixels that the triangles cover and the picture does not, or where it shows what is behind.
  void add_holes(ErrorReport& report) const {
    const ReferencePicture polygons = draw_polygons(prepared_, prepared_.frames.front());
    std::int64_t holes = 0, behind = 0;
    for (std::size_t i = 0; i < polygons.colour.size(); ++i) {
      if (polygons.colour[i] == kNoColour) continue;
      holes += first_.colour[i] == kZbvEmptyColour;
      behind += first_.colour[i] != kZbvEmptyColour && first_.depth[i] > polygons.depth[i] + prepared_.views.threshold;
    }
    report.extra.emplace_back("polygon_pixels", static_cast<double>(polygons.covered()));
    report.extra.emplace_back("hole_pixels", static_cast<double>(holes));
    report.extra.emplace_back("behind_pixels", static_cast<double>(behind));
  }

  RunSettings settings_;
  Prepared prepared_;
  Programs programs_;
  Bytes tree_;
  base::ScratchFile saved_views_;
  Digest digest_{};
  ViewsFacts stored_;
  std::size_t stored_bytes_ = 0;
  DrawnPicture first_;
  mutable std::optional<ReferencePicture> reference_;
};

}  // namespace

std::string program_suffix(const scene::Scene& scene) {
  scene::Options options = scene.options;
  const std::string compiler = options.choice("compiler", "O2", {"O2", "O1", "fcr31"});
  const bool mapped = options.boolean("mapped", true);
  return (compiler == "O2" ? "" : "-" + compiler) + (mapped ? "" : "-unmapped");
}

std::unique_ptr<ProgramJob> make_job(const scene::Scene& scene, Programs programs) {
  return std::make_unique<ViewsJob>(scene, std::move(programs));
}

}  // namespace dendro::zbuffer_views
