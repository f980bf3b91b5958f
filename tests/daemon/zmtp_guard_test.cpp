// What a client may send to a ZeroMQ socket, decided from the framing (ZMTP) alone.
#include "daemon/status/zmtp_guard.h"

#include <gtest/gtest.h>

namespace merlin::status {
namespace {

constexpr std::size_t kAll = ~std::size_t{0};

std::string greeting(const std::string& mechanism) {
  std::string text("\xff\0\0\0\0\0\0\0\1\x7f\3\0", 12);
  text += mechanism;
  text.resize(64);
  return text;
}

std::string frame(int flags, const std::string& body) {
  return std::string{static_cast<char>(flags), static_cast<char>(body.size())} + body;
}

const std::string kPing = frame(4, std::string("\4PING\0\x10", 7));

class Guard : public testing::Test {
 protected:
  // Returns the reason why `input` is refused; empty if it is accepted.
  static std::string refusal(const ZmtpLimits& limits, const std::string& input) {
    ZmtpGuard guard(limits);
    const auto followed = guard.follow(input, kAll);
    return followed ? "" : followed.error().what;
  }
  // Returns the reason why a greeting followed by `count` copies of the frame `one` is refused;
  // empty if it is accepted.
  static std::string ofMany(const std::string& mechanism, const std::string& one, int count) {
    std::string input = greeting(mechanism);
    for (int i = 0; i < count; ++i) input += one;
    return refusal({1024, 1, 4096}, input);
  }
};

TEST_F(Guard, ACommandBetweenTwoPartsDoesNotEndTheMessage) {
  const std::string part = frame(1, "part");
  EXPECT_EQ(refusal({}, greeting("NULL") + part + kPing + frame(0, "last") + part), "");
  EXPECT_EQ(refusal({}, greeting("NULL") + part + kPing + part + kPing + part),
            "a message of more than 2 parts");
}

TEST_F(Guard, ARequestIsAnEmptyPartAndOneMore) {
  const ZmtpLimits limits{4096, 2, 0, true};
  const std::string start = greeting("NULL"), empty = frame(1, ""), body = frame(0, "{}");
  EXPECT_EQ(refusal(limits, start + empty + body + kPing + empty + kPing + body), "");
  for (const std::string& bad : {body, frame(0, ""), frame(1, "x") + body, empty + empty + body})
    EXPECT_NE(refusal(limits, start + empty + body + bad), "") << "a reply would go astray";
}

TEST_F(Guard, ACommandIsOnePart) {
  EXPECT_EQ(refusal({}, greeting("NULL") + frame(5, std::string("\4PING\0\x10", 7))),
            "a command of several parts");
}

TEST_F(Guard, ASubscriptionAsLongAsAnEncryptedHeartbeatCountsWhereNothingIsEncrypted) {
  for (const std::size_t size : {38U, 39U, 40U}) {
    const std::string subscription = frame(0, '\1' + std::string(size - 1, 'x'));
    EXPECT_EQ(ofMany("NULL", subscription, 120), "subscriptions of more than 4096 bytes in total")
        << size;
  }
  EXPECT_EQ(ofMany("CURVE", frame(0, std::string(39, 'x')), 120),
            "subscriptions of more than 4096 bytes in total");
}

TEST_F(Guard, HeartbeatsAreFree) {
  EXPECT_EQ(ofMany("NULL", kPing, 2000), "");
  EXPECT_EQ(ofMany("CURVE", frame(0, std::string(40, 'x')), 2000), "");
  EXPECT_EQ(ofMany("CURVE", frame(0, std::string(38, 'x')), 2000), "");
}

}  // namespace
}  // namespace merlin::status
