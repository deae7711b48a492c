"""The neutral store: one HDF5 file for geometry, modes, FRFs, pairs, MAC, matrices and history.

Layout, version 1 (``/`` carries ``format = "trueup"`` and ``version = 1``)::

    /geometry, /test_geometry     ids, xyz [length_unit], elements/SHAPE, element_ids/SHAPE
    /modes/NAME                   frequencies_hz, shapes, damping, generalized_mass, dofs/...
    /frfs/NAME                    frequencies_hz, values, responses/..., references/...
    /functions/NAME               abscissa, values, and what they are as attributes
    /dofs/NAME                    node, component, axis
    /mac/NAME                     test, analysis, values
    /matrices/NAME                a dense dataset, or data, indices, indptr of a CSR matrix;
                                  attribute `name` where its source calls it otherwise
    /pairs, /history              tables: one dataset a column

NAME may be nested by slashes. Every group says what it is (``kind``) and every dataset its
``units`` and, where it is not plain, its ``meaning``. Missing numbers are NaN.
"""

from .describe_store import describe_store, is_store
from .read_store import read_store
from .store_content import StoreContent
from .write_store import write_store

__all__ = ["StoreContent", "describe_store", "is_store", "read_store", "write_store"]
