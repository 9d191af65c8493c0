#!/usr/bin/env python3
"""Prints what VTK's own reader finds in a VTKHDF or VTP file, as JSON: for the tests of field files."""
import json
import math
import sys

from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def numbers(array):
    values = []
    for k in range(array.GetNumberOfTuples()):
        row = array.GetTuple(k)
        values.extend(v if math.isfinite(v) else None for v in row)
    return {"components": array.GetNumberOfComponents(), "type": array.GetDataTypeAsString(), "values": values}


def arrays(data):
    return {data.GetArrayName(k): numbers(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def grid(path):
    reader = vtkXMLPolyDataReader() if path.endswith(".vtp") else vtkHDFReader()
    failed = []
    reader.AddObserver("ErrorEvent", lambda *_: failed.append(path))
    reader.SetFileName(path)
    if not path.endswith(".vtp") and not reader.CanReadFile(path):
        sys.exit(f"{path}: VTK cannot read it")
    reader.Update()
    if failed:
        sys.exit(f"{path}: VTK reports an error")
    g = reader.GetOutput()
    cells = []
    for k in range(g.GetNumberOfCells()):
        cell = g.GetCell(k)
        cells.append([cell.GetCellType()] + [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())])
    return {
        "class": g.GetClassName(),
        "points": numbers(g.GetPoints().GetData()) if hasattr(g, "GetPoints") and g.GetPoints() else None,
        "cells": cells,
        "point_data": arrays(g.GetPointData()),
        "cell_data": arrays(g.GetCellData()),
        "field_data": arrays(g.GetFieldData()),
    }


json.dump([grid(path) for path in sys.argv[1:]], sys.stdout)
