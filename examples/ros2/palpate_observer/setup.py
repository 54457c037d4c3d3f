"""The ament_python package palpate_observer; palpate itself comes from PyPI (`pip install palpate`)."""

from setuptools import setup

NAME = "palpate_observer"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/observer.launch.py"]),
        (f"share/{NAME}/config", ["config/observer.yaml"]),
    ],
    install_requires=["setuptools", "palpate"],
    zip_safe=True,
    maintainer="The palpate developers",
    maintainer_email="palpate@example.org",
    description="Equilibrium force, time to slip and warnings of a grip on a soft object",
    license="MIT OR Apache-2.0",
    entry_points={"console_scripts": [f"observer = {NAME}.node:main"]},
)
