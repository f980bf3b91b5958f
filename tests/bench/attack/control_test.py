"""That a client who does not reach merlind is not said to have got nothing."""
import os
import sys
import tempfile
import time
import types
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))

import control
import figures

SERVER = {"accepted": 3, "refused": 4, "connections": 1, "broken": 2}


class Reached(unittest.TestCase):
    def test_taken_and_refused_connections_are_met(self):
        self.assertEqual(control.met({"servers": {control.SERVER: SERVER}}), 7)

    def test_each_attacker_has_to_try_and_to_reach_merlind(self):
        control.expect_reached(control.no_key, 5, 1)
        for tries, clients in ((0, 1), (5, 0)):
            with self.assertRaises(figures.DidNotRun):
                control.expect_reached(control.no_key, tries, clients)

    @unittest.skipIf(os.geteuid() != 0, "only root can become another user")
    def test_a_socket_that_is_not_there_keeps_no_other_user_out(self):
        with tempfile.TemporaryDirectory() as folder:
            attacked = types.SimpleNamespace(options=types.SimpleNamespace(folder=folder), local=f"{folder}/none")
            with self.assertRaisesRegex(figures.DidNotRun, "No such file"):
                control.other_user(attacked, time.monotonic() + 0.1)


if __name__ == "__main__":
    unittest.main()
