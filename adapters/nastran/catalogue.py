"""Which bulk data cards are read, which carry nothing for normal modes, which are refused."""

from __future__ import annotations

from typing import NamedTuple


class Kind(NamedTuple):
    """How a card is read.

    Parameters
    ----------
    cls : str
        pyNastran's class, or "" where the raw fields are used as they are.
    id : str
        Attribute that holds the card's number; "" where cards have none of their own; "#" where
        the first field holds a number that may repeat.
    stride : int
        Fields apart of several properties on one card; 0 where there is one.
    """

    cls: str
    id: str
    stride: int = 0


def _words(text: str) -> list[str]:
    return text.split()


def _same(names: str, id: str) -> dict[str, Kind]:
    return {name: Kind(name, id) for name in names.split()}


READ: dict[str, Kind] = {
    # points and coordinate systems
    "GRID": Kind("GRID", "nid"),
    "GRDSET": Kind("", ""),
    "SPOINT": Kind("SPOINTs", ""),
    **_same("CORD2R CORD2C CORD2S", "cid"),
    "CORD1R": Kind("CORD1R", "cid", 4),
    "CORD1C": Kind("CORD1C", "cid", 4),
    "CORD1S": Kind("CORD1S", "cid", 4),
    # elements
    **_same("CQUAD4 CTRIA3 CQUAD8 CTRIA6 CQUADR CTRIAR CSHEAR", "eid"),
    "CTETRA": Kind("CTETRA4 CTETRA10 7", "eid"),
    "CPYRAM": Kind("CPYRAM5 CPYRAM13 8", "eid"),
    "CPENTA": Kind("CPENTA6 CPENTA15 9", "eid"),
    "CHEXA": Kind("CHEXA8 CHEXA20 11", "eid"),
    **_same("CBAR CBEAM CROD CONROD CTUBE CBUSH CBUSH1D", "eid"),
    **_same("CELAS1 CELAS2 CELAS3 CELAS4 CVISC CDAMP1 CDAMP2 CDAMP3", "eid"),
    "CDAMP4": Kind("CDAMP4", "eid", 4),
    **_same("CMASS1 CMASS2 CMASS3 CONM1 CONM2", "eid"),
    "CMASS4": Kind("CMASS4", "eid", 4),
    "BAROR": Kind("BAROR", ""),
    "BEAMOR": Kind("BEAMOR", ""),
    # properties
    **_same("PSHELL PCOMP PCOMPG PSHEAR PSOLID PBAR PBARL PBEAM PBEAML PROD PTUBE", "pid"),
    **_same("PBUSH PBUSH1D", "pid"),
    "PELAS": Kind("PELAS", "pid", 4),
    "PMASS": Kind("PMASS", "pid", 2),
    "PDAMP": Kind("PDAMP", "pid", 2),
    "PVISC": Kind("PVISC", "pid", 4),
    # materials
    **_same("MAT1 MAT2 MAT8 MAT9", "mid"),
    **{name: Kind("", "#") for name in ("MATT1", "MATT2", "MATT8", "MATT9")},
    **_same("TABLEM1 TABLEM2 TABLEM3 TABLEM4", "tid"),
    "TEMP": Kind("", ""),
    "TEMPD": Kind("", ""),
    # mass that belongs to no card of its own
    **{name: Kind("", "#") for name in ("NSM", "NSM1", "NSML", "NSML1", "NSMADD")},
    # constraints
    **_same("SPC SPC1 SPCADD MPC MPCADD", ""),
    **_same("RBE1 RBE2 RBE3 RBAR RBAR1 RROD", "eid"),
    **{name: Kind("", "") for name in ("ASET", "ASET1", "OMIT", "OMIT1")},
    **{name: Kind("", "") for name in ("SUPORT", "SUPORT1")},
    # the rest
    **_same("EIGRL EIGR", "sid"),
    "PARAM": Kind("", ""),
    "DMIG": Kind("", ""),
    "DTI": Kind("", ""),
}  # fmt: skip
"""Cards that are read, by name."""

SHARED_NUMBERS = (
    ("CORD2R", "CORD2C", "CORD2S", "CORD1R", "CORD1C", "CORD1S"),
    ("PSHELL", "PCOMP", "PCOMPG"),
    ("PBAR", "PBARL"),
    ("PBEAM", "PBEAML"),
    ("MAT1", "MAT2", "MAT8", "MAT9"),
)
"""Kinds of cards that are referred to by number alone: no two may have the same."""

_WHY_NOT = {
    "loads do not enter normal modes": "FORCE FORCE1 FORCE2 MOMENT MOMENT1 MOMENT2 PLOAD PLOAD1 "
    "PLOAD2 PLOAD4 PLOADX1 LOAD GRAV RFORCE RFORCE1 ACCEL ACCEL1 SLOAD SPCD SPCR LSEQ DLOAD TLOAD1 "
    "TLOAD2 RLOAD1 RLOAD2 DAREA DELAY DPHASE TEMPRB TEMPP1 TEMPP2 TEMPP3 TEMPF TIC DEFORM QVOL "
    "LOADCYN LOADCYH CLOAD ACSRCE BOLTFOR BOLTLD",
    "it belongs to response analyses": "FREQ FREQ1 FREQ2 FREQ3 FREQ4 FREQ5 TSTEP TSTEP1 TSTEPNL "
    "TABLED1 TABLED2 TABLED3 TABLED4 TABDMP1 TABRND1 TABRNDG TABLES1 TABLEST RANDPS RANDT1 NLPARM "
    "NLPCI NLCNTL NLCNTL2 EIGC EIGB EIGP EPOINT TF NOLIN1 NOLIN2 NOLIN3 NOLIN4 RCROSS RSPINR "
    "RSPINT ROTORG ROTORD UNBALNC SDAMP HYBDAMP DTEMP",
    "damping does not enter normal modes": "CDAMP5 PDAMP5 CVISC2 PDAMPT PELAST PBUSHT TABDMP2",
    "it belongs to heat transfer": "MAT4 MAT5 MATT4 MATT5 CHBDYE CHBDYG CHBDYP PHBDY CONV CONVM "
    "PCONV PCONVM QBDY1 QBDY2 QBDY3 QHBDY QVECT RADBC RADM RADMT RADSET RADCAV RADLST VIEW VIEW3D "
    "TEMPBC",
    "it belongs to nonlinear analyses": "MATS1 MATS3 MATS8 MATT3 CREEP MATHP MATEP MATF MATVE "
    "TABLEH1 TABLEHT BCPARA BCTPARM BCTPARA BCONPRG BCONPRP",
    "it belongs to optimisation": "DESVAR DVPREL1 DVPREL2 DVMREL1 DVMREL2 DVCREL1 DVCREL2 DVGRID "
    "DVSHAP DVBSHAP DRESP1 DRESP2 DRESP3 DCONSTR DCONADD DDVAL DLINK DOPTPRM DSCREEN DTABLE DEQATN "
    "DTABLE2 TOPVAR BEADVAR DVTREL1 DMNCON GROUP MODTRAK BNDGRID DVLREL1",
    "it belongs to aerodynamics": "CAERO1 CAERO2 CAERO3 CAERO4 CAERO5 PAERO1 PAERO2 PAERO3 PAERO4 "
    "PAERO5 SPLINE1 SPLINE2 SPLINE3 SPLINE4 SPLINE5 SPLINE6 SPLINE7 AERO AEROS AESTAT AESURF "
    "AESURFS AELINK AELIST AEPARM AEFACT AECOMP AECOMPL AEPRESS AEFORCE TRIM TRIM2 DIVERG FLUTTER "
    "FLFACT MKAERO1 MKAERO2 GUST CSSCHD MONPNT1 MONPNT2 MONPNT3 MONDSP1",
    "it is for drawing, output or control only": "PLOTEL PLOTEL3 PLOTEL4 PLOTEL6 PLOTEL8 PLOTHEX "
    "PLOTPEN PLOTPYR PLOTTET SET1 SET2 SET3 MDLPRM ECHOON ECHOOFF SEQGP CBARAO USET USET1 PANEL "
    "CYSYM GMCURV GMSURF FEEDGE FEFACE OUTRCV TEMPG DMI DMIJ DMIJI DMIK SKIPON "
    "SKIPOFF ENDDATA POINT SWLDPRM BSURF BSURFS BCPROP BCPROPS BLSEG NXSTRAT ITER CONTRLT",
    "no card refers to it in what is read": "PBEND PLPLANE PLSOLID PGAP PWELD PFAST PSEAM PBMSECT "
    "PBRSECT PBARN1 PBEMN1 PSHLN1 PSHLN2 PSLDN1 PCOMPS PBCOMP PBEAM3 PRAC2D PRAC3D PAXSYM PPLANE "
    "MAT3 MAT10 MAT11 MATT3 MATT11 MATG PBUSH2D",
}  # fmt: skip

IGNORED: dict[str, str] = {n: why for why, names in _WHY_NOT.items() for n in names.split()}
"""Cards that carry neither stiffness nor mass nor constraint by themselves, with the reason."""

ELEMENTS_LEFT_OUT = frozenset(
    n for n in IGNORED if n.startswith(("CHBDY", "CONV", "CAERO", "CDAMP", "CVISC"))
)
"""Those among them that connect grids: said in a warning, not in the list of skipped cards only."""

REFUSED: dict[str, str] = {
    **dict.fromkeys(
        _words(
            "CBEND CBEAM3 CWELD CFAST CSEAM CINTC CGAP CBUSH2D CRAC2D CRAC3D CTRIAX CTRIAX6 CQUADX "
            "CQUADX4 CQUADX8 CTRAX3 CTRAX6 CQUAD CPLSTN3 CPLSTN4 CPLSTN6 CPLSTN8 CPLSTS3 CPLSTS4 "
            "CPLSTS6 CPLSTS8 CCONEAX CDUM1 CDUM2 CDUM3 CDUM4 CDUM5 CDUM6 CDUM7 CDUM8 CDUM9 GENEL "
            "CIFHEX CIFPENT CIFQUAD CBELL BOLT CHEXCZ CPENTCZ CFLUID2 CFLUID3 CFLUID4 CAXIF2 "
            "CAXIF3 CAXIF4 CSLOT3 CSLOT4 CHACAB CHACBR CAABSF ACMODL MFLUID"
        ),
        "its stiffness or mass is not supported",
    ),
    **dict.fromkeys(
        _words("RSPLINE RSSCON RTRPLT RTRPLT1 RBE2F RJOINT RGYRO CYJOIN CYAX"),
        "this rigid element or constraint is not supported",
    ),
    **dict.fromkeys(
        _words("BGSET BGADD BEDGE BCTSET BCTADD BCTABLE BCTABL1 BCBODY BCBODY1 BCONP"),
        "glue and contact are not supported",
    ),
    **dict.fromkeys(
        _words("QSET QSET1 BSET BSET1 CSET CSET1 BNDFIX BNDFIX1 BNDFREE BNDFREE1 DYNRED SENQSET"),
        "component modes (sets q, b, c) are not supported: give the model without this reduction",
    ),
    **dict.fromkeys(
        _words(
            "CSUPER CSUPEXT SEELT SESET SECONCT SEBULK SELOC SETREE RELEASE SEBNDRY SECSET SEBSET "
            "SEQSET SEUSET EXTRN"
        ),
        "superelements are not supported: give the assembled deck",
    ),
    **dict.fromkeys(
        _words("RINGAX POINTAX GRIDB GRIDF RINGFL CORD3G CORD3R GMCORD SPCAX MPCAX SPCOFF SPCOFF1"),
        "it defines or constrains points in a way that is not supported",
    ),
}
"""Cards that carry stiffness, mass or constraint and are not supported, with the sentence."""


def refusal(name: str) -> str | None:
    """Return why a card that is met and not read is an error; None when a warning is enough."""
    if name in REFUSED:
        return REFUSED[name]
    if name in READ or name in IGNORED:
        return None
    if name[:1] in ("C", "R") or name[:3] in ("SPC", "MPC"):
        return "this card is not known and its name is that of an element or a constraint"
    return None
