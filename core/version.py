"""The version of trueup."""

VERSION = "0.1.0"
