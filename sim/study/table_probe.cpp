#include "sim/study/table_probe.h"

namespace dendro::study {
namespace {

class ProbeJob : public Job {
 public:
  ProbeJob(const Probe& probe, lib::ProgramImage image) : probe_(probe), image_(std::move(image)) {}

  void run(HostPort& host) override {
    lib::RdsDriver driver(host);
    host.phase("load_program");
    driver.load_program(image_);
    host.phase("finish");
    probe_.run(host, driver, image_, facts_);
  }

  ErrorReport compare(const MachineView&) const override {
    ErrorReport report;
    report.extra = facts_;
    return report;
  }
  std::vector<Layer> layers(const MachineView&) const override { return {}; }
  std::vector<std::string> input_files() const override { return {}; }
  std::vector<FirmwareImage> firmware() const override {
    return {{image_.name, image_.sha256, image_.symbols}};
  }
  std::vector<std::pair<std::string, double>> facts() const override { return {}; }

 private:
  const Probe& probe_;
  lib::ProgramImage image_;
  Probe::Facts facts_;
};

}  // namespace

ProbeRequest::ProbeRequest(const TableContext& context, const std::string& name, const std::string& machine,
                           std::function<std::unique_ptr<Job>(const config::ParameterSet&)> make,
                           const std::string& level) {
  ExecArguments arguments;
  arguments.machine = machine;
  arguments.settings = parameter_settings(context, machine.substr(0, machine.find(':')));
  request_.catalogue = &context.catalogue;
  request_.preset = exec_preset(context.catalogue, arguments);
  request_.type = context.catalogue.machine(request_.preset.machine);
  algorithm_ = {"probe", name, {request_.preset.machine}, "",
                [make = std::move(make)](const scene::Scene&, const MachineType&, const config::ParameterSet& parameters) {
                  return make(parameters);
                }};
  request_.algorithm = &algorithm_;
  request_.level = level_of(level.empty() ? context.options.level : level, *request_.type);
  request_.file.scene.name = name;
  request_.file.scene.algorithm = algorithm_.name;
}

ProbeRequest::ProbeRequest(const TableContext& context, const Probe& probe, const std::string& level)
    : ProbeRequest(
          context, probe.name, probe.machine,
          [&probe](const config::ParameterSet& parameters) {
            return std::make_unique<ProbeJob>(probe, program_image(probe.program, parameters));
          },
          level) {
  if (probe.counted && request_.level == Level::kFunction)
    request_.options.counted = probe.counted(program_image(probe.program, request_.preset.parameters));
}

stats::RunObject probe_counts(const TableContext& context, const Probe& probe) {
  const ProbeRequest request(context, probe, level_name(Level::kFunction));
  const RunMaker make = worker_runs(1, context.progress, probe.name, &context.cache, Pictures::kCompared);
  return from_bytes(make({request.request()}).front().value()).object;
}

Propagated propagate_probe(const TableContext& context, const Probe& probe,
                           const std::vector<Metric>& metrics) {
  check_level(context);
  const ProbeRequest request(context, probe);
  return propagate_request(context, request.request(), metrics, probe.name);
}

double executions(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, count] : run.executions)
    if (key == name) return static_cast<double>(count);
  return 0;
}

}  // namespace dendro::study
