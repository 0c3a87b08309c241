"""Render the scene beside this file: python render.py [--seed N] [--spp N] [--integrator NAME] [-D KEY VALUE]... -o OUT.exr

Needs the package pyluxcore. (Its own pyluxcore-console 2.11.2 stops with a TypeError before it renders.)
"""

import argparse
import os
import time

import pyluxcore

parser = argparse.ArgumentParser()
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--spp", type=int, default=64)
parser.add_argument("--integrator", default="BIDIRCPU")
parser.add_argument("-D", nargs=2, action="append", default=[], metavar=("KEY", "VALUE"))
parser.add_argument("-o", "--output", required=True)
arguments = parser.parse_args()
output = os.path.abspath(arguments.output)
os.chdir(os.path.dirname(os.path.abspath(__file__)))

pyluxcore.Init(lambda message: None)
properties = pyluxcore.Properties("render.cfg")
chosen = {
    "renderengine.type": arguments.integrator,
    "renderengine.seed": arguments.seed,
    "batch.haltspp": arguments.spp,
    "film.outputs.0.filename": output,
    **dict(arguments.D),
}
for key, value in chosen.items():
    properties.Set(pyluxcore.Property(key, value))
session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties))
session.Start()
# An image from before the last pass is short of light: the renderer halts by itself.
while not session.HasDone():
    time.sleep(0.05)
    session.UpdateStats()
session.Stop()
session.GetFilm().SaveOutput(output, pyluxcore.FilmOutputType.RGB, pyluxcore.Properties())
pyluxcore.SetLogHandler(None)
