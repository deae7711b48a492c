"""Cards that are known and not read: left out with a reason, or refused with one."""

from ..deck.card_definition import Card
from ..deck.movable_values import Moves

_IGNORED = {
    "loads do not enter normal modes": "FORCE FORCE1 FORCE2 MOMENT MOMENT1 MOMENT2 PLOAD PLOAD1 "
    "PLOAD2 PLOAD4 PLOADX1 LOAD GRAV RFORCE RFORCE1 ACCEL ACCEL1 SLOAD SPCD SPCR LSEQ DLOAD TLOAD1 "
    "TLOAD2 RLOAD1 RLOAD2 DAREA DELAY DPHASE TEMPRB TEMPP1 TEMPP2 TEMPP3 TEMPF TIC DEFORM QVOL "
    "RFORCE2 TEMPB3 LOADCYN LOADCYH CLOAD ACSRCE BOLTFOR BOLTLD",
    "it belongs to response analyses": "FREQ FREQ1 FREQ2 FREQ3 FREQ4 FREQ5 TSTEP TSTEP1 TSTEPNL "
    "TABLED1 TABLED2 TABLED3 TABLED4 TABRND1 TABRNDG TABLES1 TABLEST RANDPS RANDT1 NLPARM "
    "NLPCI NLCNTL NLCNTL2 EIGC EIGB EIGP TF NOLIN1 NOLIN2 NOLIN3 NOLIN4 RCROSS RSPINR "
    "RSPINT RGYRO ROTORG ROTORD ROTOR ROTHYBD UNBALNC CAMPBLL SDAMP HYBDAMP DTEMP "
    "RVDOF RVDOF1 RLOADEX ROTBENT ROTPARM ROTSE",
    "damping does not enter normal modes": "CDAMP5 PDAMP5 CVISC2 PDAMPT PELAST PBUSHT TABDMP2",
    "it belongs to heat transfer": "MAT4 MAT5 MATT4 MATT5 CHBDYE CHBDYG CHBDYP PHBDY CONV CONVM "
    "PCONV PCONVM QBDY1 QBDY2 QBDY3 QHBDY QVECT RADBC RADM RADMT RADSET RADCAV RADLST VIEW VIEW3D "
    "TEMPBC RADMTX RADBND RADC RADCOL RADCT",
    "it belongs to nonlinear analyses": "MATS1 MATS3 MATS8 CREEP MATHP MATEP MATF MATVE "
    "TABLEH1 TABLEHT MPCREEP BCPARA BCTPARM BCTPARA BCRPARA BCONPRG BCONPRP",
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
    "SKIPOFF ENDDATA SWLDPRM BSURF BSURFS BCPROP BCPROPS BLSEG NXSTRAT ITER CONTRLT "
    "NASTRAN",
    "contact does not act in normal modes without loads before them": "BCTSET BCTADD BEDGE",
    "modes are found without dynamic reduction": "DYNRED",
    "it keeps points out of AUTOSPC, which holds what has no stiffness": "SPCOFF SPCOFF1",
    "superelements are solved whole, not condensed to their boundaries": "SESET SEELT SETREE "
    "SELABEL SELOAD SESUP SEMPLN SENQSET SEQSET SEQSET1 SECSET SECSET1 SEBSET SEBSET1 SEUSET "
    "SEUSET1 CSUPEXT",
    "no card refers to it in what is read": "PLPLANE PSEAM PBMSECT "
    "PBRSECT PBARN1 PBEMN1 PSHLN1 PSHLN2 PSLDN1 PRAC2D PRAC3D PAXSYM PPLANE "
    "MAT10 MATT3 MATT11 MATG PBUSH2D",
}  # fmt: skip
"""Cards that carry neither stiffness nor mass nor constraint by themselves: why, the names."""

_REFUSED = {
    "its stiffness or mass is not supported":
    "CSEAM CINTC CBUSH2D CRAC2D CRAC3D CTRIAX CQUADX "
    "CQUAD CPLSTN3 CPLSTN4 CPLSTN6 CPLSTN8 CPLSTS3 CPLSTS4 CPLSTS6 "
    "CPLSTS8 CCONEAX CDUM1 CDUM2 CDUM3 CDUM4 CDUM5 CDUM6 CDUM7 CDUM8 CDUM9 CIFHEX CIFPENT "
    "CIFQUAD CBELL CHEXCZ CPENTCZ CFLUID2 CFLUID3 CFLUID4 CAXIF2 CAXIF3 CAXIF4 CSLOT3 CSLOT4 "
    "CHACAB CHACBR CAABSF",
    "this rigid element or constraint is not supported":
    "RSSCON RBE2F",
    "glue (where BGSET selects it) is not supported": "BGSET BGADD",
    "bodies in contact (where BCONTACT selects them) are not supported":
    "BCTABLE BCTABL1 BCBODY BCBODY1 BCONP",
    "bolts are not supported": "BOLT",
    "copied and released superelements are not supported: give the assembled deck":
    "CSUPER RELEASE",
    "it defines or constrains points in a way that is not supported":
    "RINGAX POINTAX GRIDB GRIDF RINGFL CORD3G CORD3R GMCORD SPCAX MPCAX CYJOIN CYAX ACMODL MFLUID",
}  # fmt: skip
"""Cards that carry stiffness, mass or constraint and are not supported: the sentence, the names."""

_SELECTED = {"BGSET": "BGSET BGADD", "BCONTACT": "BCTABLE BCTABL1 BCBODY BCBODY1 BCONP"}
"""Those that do something only where case control has a command: it, the names."""

_SAID = ("CHBDY", "CONV", "CAERO", "CDAMP", "CVISC")
"""Those that connect grids: elements, and leaving them out is said in a warning too."""

_CONDENSED = ("SESET", "SEELT", "SENQSET", "SEQSET", "BCTSET", "DYNRED", "SPCOFF")
"""Those without which frequencies are others than Nastran's, which is said too."""

_LAYOUTS = {
    "MAT10": "MID:i BULK:r RHO:r C:r GE:r",
}
"""Of those among them whose values may be written all the same."""

CARDS = (
    *(
        Card(
            name,
            _LAYOUTS.get(name, "EID:i" if name.startswith(_SAID) else ""),
            ignored=why,
            warned=name.startswith((*_SAID, *_CONDENSED)),
            moves=Moves() if name in _LAYOUTS else None,
        )
        for why, names in _IGNORED.items()
        for name in names.split()
    ),
    *(
        Card(
            name,
            "EID:i" if "stiffness" in why or "rigid" in why else "",
            refused=why,
            selected_by=next(
                (command for command, those in _SELECTED.items() if name in those.split()), ""
            ),
        )
        for why, names in _REFUSED.items()
        for name in names.split()
    ),
)
