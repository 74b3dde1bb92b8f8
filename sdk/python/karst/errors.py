"""The error of this module."""


class Error(Exception):
    """A file, a call or a policy is wrong: the text says where, and why.

    A service of the host that refuses a call raises it, and a policy may raise it to give up.
    """
