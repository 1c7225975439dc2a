// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// caplet doctor on this machine, and on one whose drivers are broken.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "program.h"
#include "support/data.h"
#include "support/device_choice.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;

struct Line {
  std::string state, text, fix;
};

std::vector<Line> findings(const std::string& out) {
  std::vector<Line> lines;
  for (const std::string& line : test::lines_of(out)) {
    if (line.starts_with("       fix: "))
      lines.back().fix = line.substr(12);
    else
      lines.push_back({line.substr(0, line.find(' ')), line.substr(7), ""});
  }
  return lines;
}

/// The wrong findings; all others must be ok or notes, and each wrong one have a fix.
std::vector<Line> wrong(const Result& result) {
  std::vector<Line> out;
  for (const Line& line : findings(result.out)) {
    EXPECT_THAT(line.state, testing::AnyOf("ok", "note", "wrong")) << line.text;
    if (line.state != "wrong") continue;
    EXPECT_NE(line.fix, "") << line.text;
    out.push_back(line);
  }
  EXPECT_EQ(result.code, out.empty() ? 0 : 1) << result.out << result.err;
  return out;
}

/// A folder of drivers with one .icd file that names `library`.
fs::path drivers_with(const std::string& library) {
  const fs::path folder = test::temporary_folder();
  test::write_file(folder / "one.icd", library + "\n");
  return folder;
}

Result doctor_with(const std::string& library, const std::vector<std::string>& arguments = {}) {
  std::vector<std::string> all{"doctor"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_program(all, test::temporary_folder(),
                           {{"OCL_ICD_VENDORS", drivers_with(library).string()}});
}

TEST(Doctor, AHealthyMachineHasNothingWrong) {
  const Result result = test::run_program({"doctor", "--timeout", "100"}, test::temporary_folder());
  EXPECT_TRUE(wrong(result).empty()) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("passes the self-test"), HasSubstr("platform "),
                                HasSubstr("cache: ")));
  EXPECT_EQ(result.err, "");
}

TEST(Doctor, JsonHoldsFindingsPlatformsAndDevices) {
  const std::string device = test::test_device_choice().empty() ? "0" : test::test_device_choice();
  const Result result = test::run_program(
      {"doctor", "--json", "--device", device, "--timeout", "100"}, test::temporary_folder());
  EXPECT_EQ(result.code, 0) << result.out;
  const auto json = nlohmann::json::parse(result.out);
  int tests = 0;
  for (const auto& finding : json.at("findings")) {
    for (const char* key : {"state", "about", "what", "fix"})
      EXPECT_TRUE(finding.at(key).is_string());
    tests += finding.at("what").get<std::string>().find("self-test") != std::string::npos &&
             finding.at("about").get<std::string>().starts_with("device ");
  }
  EXPECT_EQ(tests, 1);
  EXPECT_GE(json.at("platforms").size(), 1u);
  const Result devices = test::run_program({"devices", "--json"}, test::temporary_folder());
  EXPECT_EQ(json.at("devices"), nlohmann::json::parse(devices.out));
}

TEST(Doctor, AnUnknownDeviceIsAUsageError) {
  const Result result =
      test::run_program({"doctor", "--device", "no such device"}, test::temporary_folder());
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("no such device"));
}

TEST(Doctor, AnEmptyFolderOfDrivers) {
  const fs::path empty = test::temporary_folder();
  const Result result = test::run_program({"doctor"}, empty, {{"OCL_ICD_VENDORS", empty.string()}});
  const std::vector<Line> found = wrong(result);
  ASSERT_EQ(found.size(), 1u) << result.out;
  EXPECT_THAT(found[0].text, AllOf(HasSubstr(empty.string()), HasSubstr("holds no .icd file")));
  EXPECT_THAT(found[0].fix, AllOf(HasSubstr("unset OCL_ICD_VENDORS"),
                                  HasSubstr("apt-get install pocl-opencl-icd")));
}

TEST(Doctor, ADriverThatIsMissing) {
  const std::vector<Line> found = wrong(doctor_with("libno-such-driver.so.7"));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].text,
              AllOf(HasSubstr("one.icd"), HasSubstr("libno-such-driver.so.7 cannot be loaded"),
                    HasSubstr("cannot open shared object file")));
  EXPECT_THAT(found[0].fix, AllOf(HasSubstr("sudo mv "), HasSubstr("one.icd.off")));
  EXPECT_THAT(found[1].text, HasSubstr("no OpenCL platform"));
}

TEST(Doctor, ADriverThatCrashes) {
  const std::vector<Line> found = wrong(doctor_with(CAPLET_DRIVER_crash));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].text, AllOf(HasSubstr(CAPLET_DRIVER_crash), HasSubstr("signal 6"),
                                   HasSubstr("this driver is broken")));
  EXPECT_THAT(found[0].fix, HasSubstr("one.icd.off"));
}

TEST(Doctor, ADriverThatHangs) {
  const std::vector<Line> found = wrong(doctor_with(CAPLET_DRIVER_hang, {"--timeout", "0.5"}));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].text,
              AllOf(HasSubstr(CAPLET_DRIVER_hang), HasSubstr("gave no answer in 0.5 s")));
}

TEST(Doctor, ABrokenDriverDoesNotHideAWorkingOne) {
  const auto json =
      nlohmann::json::parse(test::run_program({"doctor", "--json"}, test::temporary_folder()).out);
  std::string working;  // one with a device
  for (const auto& finding : json.at("findings")) {
    if (finding.at("state") != "ok" ||
        !finding.at("what").get<std::string>().starts_with("the driver "))
      continue;
    std::string driver = finding.at("what").get<std::string>().substr(11);
    driver.erase(driver.find(' '));
    const fs::path alone = test::temporary_folder();
    test::write_file(alone / "one.icd", driver + "\n");
    const Result devices =
        test::run_program({"devices", "--json"}, alone, {{"OCL_ICD_VENDORS", alone.string()}});
    if (!nlohmann::json::parse(devices.out).empty()) working = driver;
  }
  ASSERT_NE(working, "");
  const fs::path folder = drivers_with(CAPLET_DRIVER_crash);
  test::write_file(folder / "two.icd", working + "\n");
  const Result result = test::run_program({"doctor", "--timeout", "100"}, test::temporary_folder(),
                                          {{"OCL_ICD_VENDORS", folder.string()}});
  EXPECT_EQ(wrong(result).size(), 1u) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("passes the self-test"),
                                HasSubstr("fix: until it is mended: "), HasSubstr(working)));
}

TEST(Doctor, ACacheFolderThatIsAFile) {
  const fs::path folder = test::temporary_folder();
  test::write_file(folder / "file", "in the way");
  const Result result = test::run_program({"doctor", "--timeout", "100"}, folder,
                                          {{"CAPLET_CACHE", (folder / "file").string()}});
  const std::vector<Line> found = wrong(result);
  ASSERT_EQ(found.size(), 1u) << result.out;
  EXPECT_THAT(found[0].text, AllOf(HasSubstr("cache: "), HasSubstr("is not a folder")));
  EXPECT_THAT(found[0].fix, HasSubstr("CAPLET_CACHE="));
}

/// Whether a process is there and not a dead one that nobody has waited for.
bool alive(const std::string& process) {
  const std::string status = test::read_file("/proc/" + process + "/stat");
  return !status.empty() && status[status.rfind(')') + 2] != 'Z';
}

TEST(Doctor, CtrlCEndsItAndItsChildren) {
  const fs::path folder = test::temporary_folder(), process = test::temporary_folder() / "process";
  test::Running running({"doctor", "--timeout", "300"}, folder,
                        {{"OCL_ICD_VENDORS", drivers_with(CAPLET_DRIVER_hang).string()},
                         {"CAPLET_TEST_PROCESS", process.string()}});
  std::string child;
  for (int i = 0; i < 6000 && !child.ends_with('\n'); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    child = test::read_file(process);
  }
  ASSERT_TRUE(child.ends_with('\n'));
  child.pop_back();
  EXPECT_TRUE(alive(child));
  running.send(SIGINT);
  EXPECT_EQ(running.wait().signal, SIGINT);
  for (int i = 0; i < 1000 && alive(child); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(alive(child));
}

}  // namespace
}  // namespace caplet
