// Who may connect to an encrypted socket, decided from ZeroMQ's request about a client's key.
#include "daemon/status/zap.h"

#include <array>

#include <gtest/gtest.h>
#include <zmq.h>

namespace merlin::status {
namespace {

// Two forms of the same key: binary, and as text.
std::string binary(char fill) { return std::string(32, fill); }
std::string text(char fill) {
  std::array<char, 41> z85{};
  const std::string key = binary(fill);
  ::zmq_z85_encode(z85.data(), reinterpret_cast<const std::uint8_t*>(key.data()), key.size());
  return z85.data();
}

std::vector<std::string> request(const std::string& domain, const std::string& key) {
  return {"1.0", "7", domain, "127.0.0.1", "", "CURVE", key};
}

class Zap : public testing::Test {
 protected:
  std::string codeOf(const std::vector<std::string>& asked) const {
    const auto answer = zapAnswer(asked, doors_);
    EXPECT_EQ(answer.size(), 6U);
    EXPECT_EQ(answer[0], "1.0");
    return answer[2] + answer[4];
  }
  Doors doors_{{"", {{text('s')}, {}}},
               {"commands", {{text('r'), text('b')}, {text('c'), text('b')}}}};
};

TEST_F(Zap, AListedKeyIsAdmittedWithWhatItMayDo) {
  EXPECT_EQ(codeOf(request("commands", binary('r'))), "200read");
  EXPECT_EQ(codeOf(request("commands", binary('c'))), "200command");
  EXPECT_EQ(codeOf(request("commands", binary('b'))), "200command") << "in both lists";
  EXPECT_EQ(codeOf(request("", binary('s'))), "200read");
  EXPECT_EQ(zapAnswer(request("commands", binary('c')), doors_)[1], "7") << "the request's id";
}

TEST_F(Zap, AKeyOpensItsOwnDoorOnly) {
  EXPECT_EQ(codeOf(request("commands", binary('s'))), "400");
  EXPECT_EQ(codeOf(request("", binary('c'))), "400");
  EXPECT_EQ(codeOf(request("elsewhere", binary('c'))), "400");
}

TEST_F(Zap, WhatIsMalformedIsRefused) {
  const auto good = request("commands", binary('c'));
  for (const char* mechanism : {"NULL", "PLAIN", "GSSAPI", "", "curve"}) {
    auto other = good;
    other[5] = mechanism;
    EXPECT_EQ(codeOf(other), "400") << mechanism;
  }
  for (std::size_t frames = 0; frames < good.size(); ++frames)
    EXPECT_EQ(codeOf({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(frames)}), "400");
  auto longer = good;
  longer.emplace_back();
  EXPECT_EQ(codeOf(longer), "400");
  auto version = good;
  version[0] = "2.0";
  EXPECT_EQ(codeOf(version), "400");
  for (const std::string& key :
       {std::string(), binary('c').substr(1), binary('c') + 'c', text('c')})
    EXPECT_EQ(codeOf(request("commands", key)), "400") << key.size();
}

// The text of a malformed key is empty, so a door whose list is empty must not accept an empty
// text.
TEST_F(Zap, AnEmptyListAdmitsNobody) {
  doors_["commands"] = {{""}, {""}};
  EXPECT_EQ(codeOf(request("commands", "")), "400");
  EXPECT_EQ(codeOf(request("commands", binary('c'))), "400");
}

TEST(Grants, TheUserIdSaysTheGrantAndNothingElseDoes) {
  for (const Grant grant : {Grant::kNothing, Grant::kRead, Grant::kCommand})
    EXPECT_EQ(grantOfUser(userOf(grant)), grant);
  for (const char* other : {"", "Read", "command ", "root"})
    EXPECT_EQ(grantOfUser(other), Grant::kNothing) << other;
}

}  // namespace
}  // namespace merlin::status
